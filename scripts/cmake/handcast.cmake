# What every room of the house is built with.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3")

option(HANDCAST_BUILD_TESTS "Build the tests and benchmarks" ON)
set(HANDCAST_SANITIZE "" CACHE STRING "Sanitizers, e.g. address,undefined or thread")

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# g++ 12 takes fmt's joining of strings for an overflow at -O3.
add_compile_options(-Wall -Wextra -Wshadow -Wno-missing-field-initializers -Wno-stringop-overflow)
if(HANDCAST_SANITIZE)
  add_compile_options(-fsanitize=${HANDCAST_SANITIZE} -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${HANDCAST_SANITIZE})
  add_compile_definitions(HANDCAST_WITH_SANITIZER)
endif()

include_directories(${CMAKE_SOURCE_DIR})
include_directories(SYSTEM /usr/include/eigen3)

find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(PkgConfig REQUIRED)

# handcast_library(name SOURCES a.cpp ... [LINKS target ...])
function(handcast_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC ${ARG_LINKS})
endfunction()

# handcast_program(name SOURCES a.cpp ... [LINKS target ...]): an executable in bin/
function(handcast_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS})
  install(TARGETS ${name} RUNTIME DESTINATION bin)
endfunction()

# handcast_test(name SOURCES a.cpp ... [LINKS target ...] [TIMEOUT seconds] [LABELS ...]): one GoogleTest program, one ctest
function(handcast_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINKS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gmock GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  set(environment "HANDCAST_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};HANDCAST_SOURCE=${CMAKE_SOURCE_DIR}")
  set_tests_properties(${name} PROPERTIES ENVIRONMENT "${environment}")
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(HANDCAST_SANITIZE)
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")  # a hang still ends; slowness is the sanitizer's
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT})
  if(ARG_LABELS)
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}")
  endif()
endfunction()
