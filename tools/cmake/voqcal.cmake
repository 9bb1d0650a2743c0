# What every target of voqcal shares. Included once, by the top CMakeLists.txt.

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

option(VOQCAL_WERROR "Treat warnings as errors" OFF)
set(VOQCAL_SANITIZE "" CACHE STRING "Comma-separated sanitizers, e.g. address,undefined")
if(VOQCAL_SANITIZE)
  add_compile_options(-fsanitize=${VOQCAL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  if(VOQCAL_SANITIZE MATCHES "address")
    # Null pointers end under ASan too; these three are a quarter of the time to compile Eigen.
    add_compile_options(-fno-sanitize=null,object-size,vptr)
  endif()
  add_link_options(-fsanitize=${VOQCAL_SANITIZE})
endif()

# The same bytes on every x86-64 machine: no -march=native, no fused multiply-add, no -ffast-math.
add_compile_options(-ffp-contract=off)

# Sanitized code linked into each of a hundred programs is 16 GB; shared by them, 2. -fPIC for the programs too:
# they use the libraries' precompiled header.
if(BUILD_SHARED_LIBS)
  add_compile_options(-fPIC)
endif()

# Everything that is installed, which is what tools/build makes; `all` has tests and benchmarks too.
add_custom_target(programs)
# The tests of units and modules (label unit), which run no program: all that the sanitizers watch.
add_custom_target(unit_tests)

# What most files include, parsed once: a third of the time to build. With it off, a file that forgets an
# include does not compile.
option(VOQCAL_PRECOMPILE "Precompile the headers that most files include" ON)

# voqcal_precompiled(NAME [HEADERS <a> ... LIBS x] [OPTIONS -o ...]): one of these and of HEADERS, for targets that
# compile with the same options. Not CLI11: its constants would be made in each file.
function(voqcal_precompiled name)
  cmake_parse_arguments(arg "" "" "HEADERS;LIBS;OPTIONS" ${ARGN})
  if(VOQCAL_PRECOMPILE)
    add_library(${name} STATIC EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/tools/cmake/precompiled.cpp)
    target_compile_options(${name} PRIVATE ${arg_OPTIONS})
    target_precompile_headers(${name} PRIVATE
      <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <optional> <sstream> <stdexcept>
      <string> <vector> <Eigen/Dense> ${arg_HEADERS})
    target_include_directories(${name} SYSTEM PRIVATE
      $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
    target_link_libraries(${name} PRIVATE ${arg_LIBS})
  endif()
endfunction()

# Tests compare: what takes time is in the libraries. A quarter less time to build them.
set(test_options $<$<CONFIG:Release>:-O1>)
voqcal_precompiled(voqcal_precompiled)

# Warnings and include root ("core/...", "messaging/...") of one target of ours, and which header it has precompiled.
function(voqcal_target_defaults target)
  cmake_parse_arguments(arg "" "PRECOMPILED" "" ${ARGN})
  if(NOT arg_PRECOMPILED)
    set(arg_PRECOMPILED voqcal_precompiled)
  endif()
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/modules)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wno-sign-conversion -Wshadow)
  if(VOQCAL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(VOQCAL_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${arg_PRECOMPILED})
  endif()
endfunction()

# voqcal_library(NAME SOURCES a.cpp ... LIBS x y): one library (static, but in dev), its headers beside its
# sources.
function(voqcal_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  add_library(${name} ${arg_SOURCES})
  voqcal_target_defaults(${name})
  target_link_libraries(${name} PUBLIC ${arg_LIBS})
endfunction()

# voqcal_program(NAME [NOT_INSTALLED] SOURCES main.cpp LIBS x y): one executable in bin/.
function(voqcal_program name)
  cmake_parse_arguments(arg "NOT_INSTALLED" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  voqcal_target_defaults(${name})
  target_link_libraries(${name} PRIVATE ${arg_LIBS})
  if(NOT arg_NOT_INSTALLED)
    install(TARGETS ${name} RUNTIME DESTINATION bin)
    add_dependencies(programs ${name})
  endif()
endfunction()

# voqcal_test(NAME SOURCES x_test.cpp LIBS x [LABELS system] [SHARDS n] [PROPERTIES p v ...]): one GoogleTest
# executable. With LABELS each TEST is one ctest test, with these properties; else the executable is (label unit), in
# so many shards (1 unless said): what a suite's tests share is made once, and hundreds of libraries are loaded once.
function(voqcal_test name)
  cmake_parse_arguments(arg "" "SHARDS" "SOURCES;LIBS;LABELS;PROPERTIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/test)
  target_compile_options(${name} PRIVATE ${test_options})
  voqcal_target_defaults(${name} PRECOMPILED voqcal_precompiled_test)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/test)
  target_compile_definitions(${name} PRIVATE VOQCAL_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${arg_LIBS} GTest::gmock GTest::gtest_main)
  if(arg_LABELS)
    gtest_discover_tests(${name} PROPERTIES LABELS "${arg_LABELS}" ${arg_PROPERTIES}
      DISCOVERY_TIMEOUT 60)
    return()
  endif()
  if(NOT arg_SHARDS)
    set(arg_SHARDS 1)
  endif()
  add_dependencies(unit_tests ${name})
  math(EXPR last "${arg_SHARDS} - 1")
  foreach(shard RANGE ${last})
    set(test ${name})
    if(arg_SHARDS GREATER 1)
      string(APPEND test .${shard})
    endif()
    add_test(NAME ${test} COMMAND ${name})
    set_tests_properties(${test} PROPERTIES LABELS unit ${arg_PROPERTIES}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()
