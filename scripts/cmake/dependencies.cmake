# SPDX-License-Identifier: Apache-2.0
# The libraries that handcast uses. scripts/setup installs all of them.

find_package(PkgConfig REQUIRED)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED)
find_package(nlohmann_json REQUIRED)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(spng REQUIRED IMPORTED_TARGET spng)
find_package(ZLIB REQUIRED)
find_package(JPEG REQUIRED)
pkg_check_modules(ffmpeg REQUIRED IMPORTED_TARGET libavformat libavcodec libavutil libswscale)
# It is loaded at run time; the header says its version.
find_path(AVDEVICE_HEADERS libavdevice/version_major.h REQUIRED)
pkg_check_modules(microhttpd REQUIRED IMPORTED_TARGET libmicrohttpd)
pkg_check_modules(gnutls REQUIRED IMPORTED_TARGET gnutls)
pkg_check_modules(libcurl REQUIRED IMPORTED_TARGET libcurl)
pkg_check_modules(libdeflate REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(eigen3 REQUIRED IMPORTED_TARGET eigen3)
find_package(TinyGLTF REQUIRED)

# Debian's targets of OpenCV lack the path of their headers.
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs videoio aruco calib3d features2d)
foreach(part core imgproc imgcodecs videoio aruco calib3d features2d)
  target_include_directories(opencv_${part} SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
endforeach()

# Only the messages of ONNX files: libonnx itself would register all operators at each start.
find_library(ONNX_PROTO_LIBRARY onnx_proto REQUIRED)
pkg_check_modules(protobuf REQUIRED IMPORTED_TARGET protobuf)

# oneDNN's own CMake file also requires OpenCL's headers.
find_library(DNNL_LIBRARY dnnl REQUIRED)
# Only to keep oneDNN to one thread. Debian's oneDNN is linked with GNU's OpenMP, and clang finds
# only its own.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  file(GLOB gnu_folder LIST_DIRECTORIES true /usr/lib/gcc/${CMAKE_LIBRARY_ARCHITECTURE}/*/include)
  find_path(OMP_HEADER omp.h HINTS ${gnu_folder} REQUIRED NO_DEFAULT_PATH)
  set(OpenMP_CXX_FLAGS -idirafter${OMP_HEADER})
  set(OpenMP_CXX_LIBRARIES gomp)
else()
  find_package(OpenMP REQUIRED COMPONENTS CXX)
endif()

# handcast_feature(NAME "what is absent without it" FOUND): HANDCAST_WITH_NAME is AUTO (on if it was
# found), ON (an error if it was not found) or OFF. Absent features are listed here and by
# `handcast --version`.
set(HANDCAST_ABSENT "")
function(handcast_feature name sentence found)
  set(HANDCAST_WITH_${name} AUTO CACHE STRING "AUTO, ON or OFF: ${sentence}")
  set(with ${HANDCAST_WITH_${name}})
  if(with STREQUAL "AUTO")
    set(with ${found})
  elseif(with AND NOT found)
    message(FATAL_ERROR "HANDCAST_WITH_${name} is ON, but its libraries were not found; scripts/setup --tests installs them")
  endif()
  set(HANDCAST_WITH_${name} ${with} PARENT_SCOPE)
  if(NOT with)
    message(STATUS "without ${name}: no ${sentence}")
    set(HANDCAST_ABSENT "${HANDCAST_ABSENT}without ${name}: no ${sentence}\\n" PARENT_SCOPE)
  endif()
endfunction()

function(handcast_found result)
  set(${result} OFF PARENT_SCOPE)
  foreach(variable ${ARGN})
    if(NOT ${variable})
      return()
    endif()
  endforeach()
  set(${result} ON PARENT_SCOPE)
endfunction()

find_package(OpenCV QUIET COMPONENTS dnn)
handcast_found(found OpenCV_dnn_FOUND)
handcast_feature(OPENCV_DNN "tests of networks against OpenCV's (libopencv-dev)" ${found})
if(HANDCAST_WITH_OPENCV_DNN)
  target_include_directories(opencv_dnn SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
endif()

# Only headers: libEGL is loaded at run time.
find_path(EGL_HEADERS EGL/eglext.h)
find_path(GL_HEADERS GL/glcorearb.h)
handcast_found(found EGL_HEADERS GL_HEADERS)
handcast_feature(GL "painter gl, which draws on a GPU (libegl-dev libgl-dev)" ${found})

pkg_check_modules(cairo QUIET IMPORTED_TARGET cairo)
handcast_found(found cairo_FOUND)
handcast_feature(CAIRO "pictures of a running rig, handcast preview (libcairo2-dev)" ${found})

pkg_check_modules(pangocairo QUIET IMPORTED_TARGET pangocairo)
handcast_found(found pangocairo_FOUND)
handcast_feature(PANGO "text as content (libpango1.0-dev)" ${found})

find_package(glfw3 QUIET)
find_package(OpenGL QUIET COMPONENTS OpenGL)
find_package(X11 QUIET)
handcast_found(found glfw3_FOUND OpenGL_OpenGL_FOUND X11_Xrandr_FOUND X11_Xext_FOUND)
handcast_feature(WINDOW "light in a window (libglfw3-dev libopengl-dev libxrandr-dev libxext-dev)" ${found})

pkg_check_modules(alsa QUIET IMPORTED_TARGET alsa)
handcast_found(found alsa_FOUND)
handcast_feature(ALSA "delay of the light by a photodiode on a sound card, sound for content (libasound2-dev)" ${found})

pkg_check_modules(rtmidi QUIET IMPORTED_TARGET rtmidi)
handcast_found(found rtmidi_FOUND)
handcast_feature(RTMIDI "MIDI controllers (librtmidi-dev)" ${found})

pkg_check_modules(drm QUIET IMPORTED_TARGET libdrm)
handcast_found(found drm_FOUND)
handcast_feature(KMS "light on a projector without a window system (libdrm-dev)" ${found})

pkg_check_modules(aravis QUIET IMPORTED_TARGET aravis-0.8)
handcast_found(found aravis_FOUND)
handcast_feature(ARAVIS "GigE Vision and USB3 Vision cameras (libaravis-dev)" ${found})

pkg_check_modules(libusb QUIET IMPORTED_TARGET libusb-1.0)
handcast_found(found libusb_FOUND)
handcast_feature(LIBUSB "Leap Motion Controllers as stereo cameras (libusb-1.0-0-dev)" ${found})

pkg_check_modules(hidapi QUIET IMPORTED_TARGET hidapi-hidraw)
handcast_found(found hidapi_FOUND)
handcast_feature(HIDAPI "commands to DLP projectors, handcast-dlp (libhidapi-dev)" ${found})

pkg_check_modules(openxr QUIET IMPORTED_TARGET openxr)
handcast_found(found openxr_FOUND)
handcast_feature(OPENXR "hand trackers of OpenXR runtimes (libopenxr-dev)" ${found})

pkg_check_modules(cyclonedds QUIET IMPORTED_TARGET CycloneDDS)
find_program(IDLC idlc)
handcast_found(found cyclonedds_FOUND IDLC)
handcast_feature(CYCLONEDDS "rigs on several computers, handcast-bridge (cyclonedds-dev cyclonedds-tools)" ${found})
if(HANDCAST_WITH_CYCLONEDDS)
  enable_language(C)  # of the types that idlc makes
endif()

find_package(prometheus-cpp QUIET)
handcast_found(found prometheus-cpp_FOUND)
handcast_feature(PROMETHEUS "metrics for Prometheus, handcast-exporter (prometheus-cpp-dev)" ${found})

pkg_check_modules(ZeroMQ QUIET IMPORTED_TARGET libzmq)
handcast_found(found ZeroMQ_FOUND)
handcast_feature(ZEROMQ "comparison with ZeroMQ in scripts/bench rings (libzmq3-dev)" ${found})

find_package(GTest QUIET)
handcast_found(found GTest_FOUND)
handcast_feature(TESTS "tests and benchmarks (libgtest-dev libgmock-dev)" ${found})
