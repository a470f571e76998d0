# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` adds to the programs and their files: rigs, documents, and the client
# library, with which programs of other people read a rig's streams. Nothing in it names the place
# it was built or installed in.
include(CMakePackageConfigHelpers)

set(share ${HANDCAST_INSTALL_SHAREDIR})
install(DIRECTORY config/rigs config/calibrations DESTINATION ${share})
install(DIRECTORY config/sweeps DESTINATION ${share} COMPONENT lab)
install(PROGRAMS scripts/get-models DESTINATION ${share}/scripts COMPONENT tools)
install(FILES scripts/lib.sh DESTINATION ${share}/scripts COMPONENT tools)
# For the programs that a rig starts, also a rig of the build folder.
install(FILES scripts/handcast.py DESTINATION ${share}/python)
configure_file(scripts/handcast.py ${CMAKE_BINARY_DIR}/share/handcast/python/handcast.py COPYONLY)

# The documents, in the folders that their links lead to.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md DECISIONS.md LICENSE
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN Doxyfile EXCLUDE)
install(DIRECTORY config/rigs DESTINATION ${CMAKE_INSTALL_DOCDIR}/config)
foreach(file
    config/REFERENCE.md config/assets/leap/bring_up.txt config/assets/desk.png config/assets/looks.png config/assets/preview.png config/assets/readme.png config/assets/readme_looks.png config/assets/template.png ipc/ring/README.md
    renderer/README.md scripts/read_recording.py services/lab/training/MODEL_CARD.md
    tests/client/CMakeLists.txt tests/client/draw_ring.c tests/client/detect_hands.py tests/client/draw_waves.py tests/client/hands_to_json.py
    tests/client/hands_to_osc.py tests/client/json_to_hands.py tests/client/paint_at_random.py tests/client/plot_error.py tests/client/read_projections.cpp)
  cmake_path(GET file PARENT_PATH folder)
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()

# The client library: five modules in one archive, and the headers that its programs include. Those
# of ipc/control are not among them, because they need a library for JSON.
add_library(handcast_client STATIC)
set_target_properties(handcast_client PROPERTIES EXPORT_NAME client LINKER_LANGUAGE CXX)
foreach(module ipc/base ipc/shm ipc/ring ipc/control ipc/client)
  handcast_target_of(${module} target)
  target_sources(handcast_client PRIVATE $<TARGET_OBJECTS:${target}>)
endforeach()
target_compile_features(handcast_client PUBLIC cxx_std_20)
target_link_libraries(handcast_client PUBLIC fmt::fmt tl::expected Threads::Threads)
target_include_directories(handcast_client INTERFACE
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/handcast>)

install(TARGETS handcast_client EXPORT handcastTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
foreach(module ipc/base ipc/msg ipc/shm ipc/ring ipc/client)
  install(DIRECTORY ${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/handcast/ipc COMPONENT dev
    FILES_MATCHING PATTERN *.hpp PATTERN *writer.hpp EXCLUDE PATTERN c_calls.hpp EXCLUDE)
endforeach()

# What the back ends of other people include, which the services load: their seams, and what those include.
add_library(handcast_back_end INTERFACE)
set_target_properties(handcast_back_end PROPERTIES EXPORT_NAME back_end)
target_link_libraries(handcast_back_end INTERFACE fmt::fmt tl::expected)
target_compile_features(handcast_back_end INTERFACE cxx_std_20)
target_include_directories(handcast_back_end INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/handcast>)
install(TARGETS handcast_back_end EXPORT handcastTargets)
install(DIRECTORY config/sections DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/handcast/config COMPONENT dev FILES_MATCHING PATTERN *.hpp)
foreach(header
    calib/calibration.hpp calib/projector_model.hpp config/rig.hpp config/settings/field.hpp config/settings/frozen_file.hpp
    config/settings/setting_list.hpp ipc/daemon/attached.hpp ipc/daemon/back_end_files.hpp ipc/daemon/description.hpp
    renderer/base/device_image.hpp renderer/base/image.hpp renderer/base/landmark_points.hpp renderer/base/mip_chain.hpp
    renderer/correct/deform.hpp renderer/correct/rung.hpp renderer/draw/painter.hpp
    renderer/hand/hand_mesh.hpp renderer/output/light.hpp renderer/pipeline/frame.hpp services/camera/camera.hpp services/joints/conventions.hpp
    services/landmarks/detector.hpp services/landmarks/geometry/points.hpp services/pose/pose_source.hpp services/projector/projector.hpp
    services/runtime/backends.hpp)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/handcast/${folder} COMPONENT dev)
endforeach()

# The library for programs that draw, in any language.
install(TARGETS handcast_c EXPORT handcastTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT dev
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ipc/client/handcast.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)

# find_package(handcast)
set(made ${CMAKE_BINARY_DIR}/package)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/handcast)
install(EXPORT handcastTargets NAMESPACE handcast:: DESTINATION ${package} COMPONENT dev)
configure_package_config_file(scripts/cmake/handcastConfig.cmake.in ${made}/handcastConfig.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(${made}/handcastConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${made}/handcastConfig.cmake ${made}/handcastConfigVersion.cmake
  DESTINATION ${package} COMPONENT dev)

# pkg-config handcast, handcast-c
set(pkgconfig ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pc /${pkgconfig} /)
string(REGEX REPLACE "/$" "" prefix_from_pc ${prefix_from_pc})
foreach(name handcast handcast-c)
  configure_file(scripts/cmake/${name}.pc.in ${made}/${name}.pc @ONLY)
  install(FILES ${made}/${name}.pc DESTINATION ${pkgconfig} COMPONENT dev)
endforeach()
