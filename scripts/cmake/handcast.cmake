# SPDX-License-Identifier: Apache-2.0
# The functions with which modules, programs and tests are declared. A module is one folder with one CMakeLists.txt and one target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3")

set(CMAKE_INSTALL_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE})
include(GNUInstallDirs)
include(components)
# Programs look for their files here as seen from their own folder, in the build and in an
# installation.
cmake_path(SET HANDCAST_INSTALL_SHAREDIR NORMALIZE "${CMAKE_INSTALL_BINDIR}/../share/handcast")

set(HANDCAST_SANITIZE "" CACHE STRING "Sanitizers, e.g. address,undefined or thread")

# A compiler cache is faster for repeated builds; precompiled headers, and the sources of a module in few compilations, for a single
# build. They do not work together. Clones in all folders share the cache.
find_program(CCACHE ccache)
set(single_build ON)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
  set(single_build OFF)
endif()
option(HANDCAST_PRECOMPILE "Precompile the headers that most sources include" ${single_build})
option(HANDCAST_UNITY "Compile up to 16 sources of a module at once" ${single_build})
set(CMAKE_UNITY_BUILD ${HANDCAST_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)

# GLib's headers (Aravis) bring it to some targets; clang refuses a precompiled header that was made without it.
add_compile_options(-pthread)

# g++ 12 at -O3 reports overflows of std::string that do not exist.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  add_compile_options(-Wall -Wextra -Wno-missing-field-initializers -Wno-unknown-pragmas)
else()
  add_compile_options(-Wall -Wextra -Wshadow -Wno-missing-field-initializers -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict
    -Wno-array-bounds)
endif()
if(HANDCAST_SANITIZE)
  add_compile_options(-fsanitize=${HANDCAST_SANITIZE} -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${HANDCAST_SANITIZE})
  add_compile_definitions(HANDCAST_WITH_SANITIZER)
endif()

# handcast_precompile(target [OPTIONS flag ...] [TEST]): lets a target use headers precompiled with the same flags.
function(handcast_precompile target)
  if(NOT HANDCAST_PRECOMPILE)
    return()
  endif()
  cmake_parse_arguments(ARG "TEST" "" "OPTIONS" ${ARGN})
  string(MAKE_C_IDENTIFIER "handcast_precompiled${ARG_OPTIONS}" from)
  set(headers <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <span> <string>
    <string_view> <utility> <variant> <vector> <fmt/format.h> <glm/glm.hpp> <tl/expected.hpp>)
  if(ARG_TEST)
    string(APPEND from _test)
    list(APPEND headers <gmock/gmock.h> <gtest/gtest.h>)
  endif()
  if(NOT TARGET ${from})
    file(WRITE ${CMAKE_BINARY_DIR}/${from}.cpp "")
    add_library(${from} OBJECT ${CMAKE_BINARY_DIR}/${from}.cpp)
    target_compile_options(${from} PRIVATE ${ARG_OPTIONS})
    # Its flags must be those of its users, or the compiler does not use it.
    target_link_libraries(${from} PRIVATE fmt::fmt $<$<BOOL:${ARG_TEST}>:GTest::gmock>)
    target_precompile_headers(${from} PRIVATE ${headers})
  endif()
  target_link_libraries(${target} PRIVATE fmt::fmt)
  target_precompile_headers(${target} REUSE_FROM ${from})
endfunction()

# handcast_source_options(a.cpp ... OPTIONS flag ...): sets the flags of single sources.
function(handcast_source_options)
  cmake_parse_arguments(ARG "" "" "OPTIONS" ${ARGN})
  set_source_files_properties(${ARG_UNPARSED_ARGUMENTS} PROPERTIES
    COMPILE_OPTIONS "${ARG_OPTIONS}" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# handcast_target_of(folder result): sets `result` to the target of the module in a folder: renderer/mask -> handcast_renderer_mask.
function(handcast_target_of folder result)
  string(REPLACE "/" "_" name ${folder})
  set(${result} handcast_${name} PARENT_SCOPE)
endfunction()

function(handcast_use target scope)
  foreach(folder ${ARGN})
    handcast_target_of(${folder} used)
    target_link_libraries(${target} ${scope} ${used})
  endforeach()
endfunction()

# handcast_module(SOURCES a.cpp ... USES folder ... [LIBRARIES target ...] [PRIVATE_LIBRARIES target ...] [OPTIONS flag ...])
#
# Declares the module of the current folder. USES: folders of modules whose headers it may include (`scripts/check_layers` checks this).
# LIBRARIES: libraries of other projects that its headers need. PRIVATE_LIBRARIES: those that only its sources need.
function(handcast_module)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES;PRIVATE_LIBRARIES;OPTIONS" ${ARGN})
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  handcast_target_of(${folder} target)
  if(ARG_SOURCES)
    set(scope PUBLIC)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_compile_options(${target} PRIVATE ${ARG_OPTIONS})
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE_LIBRARIES})
    handcast_precompile(${target} OPTIONS ${ARG_OPTIONS})
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${CMAKE_SOURCE_DIR})
  target_link_libraries(${target} ${scope} ${ARG_LIBRARIES})
  handcast_use(${target} ${scope} ${ARG_USES})
endfunction()

# handcast_back_ends(folder ...): links the implementations that the table of back ends of the current module names. They include the
# module's interface, and none of its sources includes them.
function(handcast_back_ends)
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  handcast_target_of(${folder} target)
  get_target_property(type ${target} TYPE)
  set(scope PUBLIC)
  if(type STREQUAL "INTERFACE_LIBRARY")
    set(scope INTERFACE)
  endif()
  handcast_use(${target} ${scope} ${ARGN})
endfunction()

# handcast_loads_back_ends(target folder ...): the program loads back ends that are files of their own. They call the program's functions,
# among which are all of the modules that every seam uses and of the modules `folder`; install.cmake installs their headers.
function(handcast_loads_back_ends target)
  set_property(TARGET ${target} PROPERTY ENABLE_EXPORTS ON)
  foreach(folder ipc/base ipc/shm ipc/ring config calib ${ARGN})
    handcast_target_of(${folder} module)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${module}>)
  endforeach()
endfunction()

# handcast_embed(source HEADER header NAMESPACE name FILES variable file ...): makes a source with the texts of files as constants of type
# std::string_view, which the header declares.
function(handcast_embed source)
  cmake_parse_arguments(ARG "" "HEADER;NAMESPACE" "FILES" ${ARGN})
  set(text "#include \"${ARG_HEADER}\"\n\nnamespace ${ARG_NAMESPACE} {\n")
  while(ARG_FILES)
    list(POP_FRONT ARG_FILES variable file)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} content)
    string(APPEND text "extern const std::string_view ${variable} = R\"file(${content})file\";\n")
  endwhile()
  string(APPEND text "}  // namespace ${ARG_NAMESPACE}\n")
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${source} CONTENT "@text@" @ONLY)
endfunction()

# handcast_program(name SOURCES a.cpp ... USES folder ... [LIBRARIES target ...] [NOT_INSTALLED]): an executable in bin/
function(handcast_program name)
  cmake_parse_arguments(ARG "NOT_INSTALLED" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES})
  handcast_use(${name} PRIVATE ${ARG_USES})
  handcast_precompile(${name})
  if(NOT ARG_NOT_INSTALLED)
    file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    handcast_install_program(TARGETS ${name} ${folder})
  endif()
endfunction()

# handcast_service(name ...): the daemon handcast-NAME, see handcast_program(). Its description is
# made by the program itself and installed with it.
function(handcast_service name)
  handcast_program(handcast-${name} ${ARGN})
  handcast_description(${name} ${name})
endfunction()

# handcast_instance(program name): handcast-PROGRAM --as NAME is the service NAME.
function(handcast_instance program name)
  handcast_description(${program} ${name} --as ${name})
endfunction()

function(handcast_description program name)
  set(folder ${CMAKE_BINARY_DIR}/share/handcast/services)
  add_custom_command(TARGET handcast-${program} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND handcast-${program} ${ARGN} --describe > ${folder}/${name}.json
    BYPRODUCTS ${folder}/${name}.json)
  file(RELATIVE_PATH source ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  handcast_component_of(${source} component)
  install(FILES ${folder}/${name}.json DESTINATION ${HANDCAST_INSTALL_SHAREDIR}/services COMPONENT ${component})
endfunction()

set(handcast_test_options -O1)

# handcast_test([SUFFIX word] SOURCES a_test.cpp ... USES folder ... [LIBRARIES target ...] [NEEDS target ...] [TIMEOUT seconds]
#               [LABELS ...] [NO_HANDS] [SHORT filter])
#
# Declares a GoogleTest program and a ctest named after the folder: tests/renderer/mask -> test_renderer_mask[_SUFFIX].
# NEEDS: targets of programs and files that the test uses when it runs; the hands made by the build are added automatically, unless
# NO_HANDS says that the test does not read them. A test with the label `threads` also runs with the thread sanitizer: see .ci/run.
# SHORT: the whole program takes minutes and has the label `nightly`; what the filter selects is a test of its own, NAME_short.
function(handcast_test)
  cmake_parse_arguments(ARG "NO_HANDS" "SUFFIX;TIMEOUT;SHORT" "SOURCES;USES;LIBRARIES;NEEDS;LABELS" ${ARGN})
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR})
  string(REPLACE "/" "_" name test_${folder})
  if(ARG_SUFFIX)
    string(APPEND name _${ARG_SUFFIX})
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gmock GTest::gtest_main)
  handcast_use(${name} PRIVATE ${ARG_USES})
  # Compiling is most of what the tests cost; what they call is optimized in its module.
  target_compile_options(${name} PRIVATE ${handcast_test_options})
  handcast_precompile(${name} TEST OPTIONS ${handcast_test_options})
  if("${ARG_USES}" MATCHES "renderer|services" AND NOT ARG_NO_HANDS)
    list(APPEND ARG_NEEDS handcast_hands)
  endif()
  if(ARG_NEEDS)
    add_dependencies(${name} ${ARG_NEEDS})
  endif()
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  set(tests ${name})
  if(ARG_SHORT)
    add_test(NAME ${name}_short COMMAND ${name} --gtest_filter=${ARG_SHORT} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    list(APPEND tests ${name}_short)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(HANDCAST_SANITIZE)
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")  # sanitizers are slow; a hang still ends
  endif()
  set_tests_properties(${tests} PROPERTIES
    TIMEOUT ${ARG_TIMEOUT}
    LABELS "${ARG_LABELS}"
    ENVIRONMENT "HANDCAST_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};HANDCAST_SOURCE=${CMAKE_SOURCE_DIR}")
  if(ARG_SHORT)
    set_property(TEST ${name} APPEND PROPERTY LABELS nightly)
  endif()
endfunction()
