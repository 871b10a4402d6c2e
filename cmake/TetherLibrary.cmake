# The one way a library, a program or a test of Tether is declared, so that compiler settings, folder
# rules and header checks are the same everywhere.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

option(TETHER_WARNINGS_AS_ERRORS "Treat every compiler warning as an error" ON)
set(TETHER_SANITIZE "" CACHE STRING "Sanitizers for -fsanitize=, e.g. address,undefined")

add_library(tether_compile_options INTERFACE)
target_compile_options(tether_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
  -Wold-style-cast -Woverloaded-virtual -Wformat=2
  $<$<BOOL:${TETHER_WARNINGS_AS_ERRORS}>:-Werror>
  # Bit-identical results on every machine: no fused multiply-add behind our back.
  -ffp-contract=off
  # In a unity build sources are included, and their unnamed namespaces look as if a header had them.
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)
if(TETHER_SANITIZE)
  add_compile_options(-fsanitize=${TETHER_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    # GCC's own instrumentation sets this one off in the standard library.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_link_options(-fsanitize=${TETHER_SANITIZE})
endif()

# Each public header is compiled alone, so that it includes all it needs.
function(_tether_check_headers target include_dir)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE "${include_dir}" "${include_dir}/*.h")
  set(sources)
  foreach(header IN LISTS headers)
    string(MAKE_C_IDENTIFIER "${header}" id)
    set(source "${CMAKE_CURRENT_BINARY_DIR}/header_check/${id}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "#include <@header@>  // IWYU pragma: keep\n" @ONLY)
    list(APPEND sources "${source}")
  endforeach()
  if(sources)
    add_library(${target}_header_check OBJECT ${sources})
    target_link_libraries(${target}_header_check PRIVATE ${target} tether_compile_options)
  endif()
endfunction()

# What each kind of test run has to build: `tether_unit_tests` and `tether_checked_tests` (asan runs
# these) and `tether_threaded_tests` (tsan), so that a sanitizer build compiles nothing that it does
# not run.
add_custom_target(tether_unit_tests)
add_custom_target(tether_threaded_tests)
add_custom_target(tether_checked_tests)

# Tests are half of all that is compiled. What nearly every one includes is compiled once, in a program, whose
# code is compiled as theirs is; and only what they test is optimised.
add_library(tether_test_options INTERFACE)
target_compile_options(tether_test_options INTERFACE $<$<CONFIG:RelWithDebInfo>:-Og>
  # Optimised that little, the standard library's own code sets this one off.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
target_link_libraries(tether_test_options INTERFACE tether_compile_options)
if(BUILD_TESTING)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/test_headers.cpp" CONTENT "int main() {}\n")
  add_executable(tether_test_headers EXCLUDE_FROM_ALL "${PROJECT_BINARY_DIR}/test_headers.cpp")
  target_link_libraries(tether_test_headers PRIVATE GTest::gmock tether_test_options)
  target_precompile_headers(tether_test_headers PRIVATE
    <algorithm> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <optional> <string> <thread> <variant>
    <vector> <gmock/gmock.h>)
endif()

# Registers the cases of a GoogleTest executable with CTest under its labels.
function(_tether_register_test target prefix)
  cmake_parse_arguments(ARG "" "TIMEOUT" "LABELS" ${ARGN})
  target_precompile_headers(${target} REUSE_FROM tether_test_headers)
  foreach(label IN ITEMS unit threaded checked)
    if(label IN_LIST ARG_LABELS)
      add_dependencies(tether_${label}_tests ${target})
    endif()
  endforeach()
  # With a sanitizer a program takes longer to load than a unit test to run: a quarter of its cases each time.
  if(TETHER_SANITIZE AND "unit" IN_LIST ARG_LABELS)
    foreach(shard RANGE 3)
      add_test(NAME ${prefix}.shard${shard} COMMAND ${target})
      math(EXPR timeout "4 * ${ARG_TIMEOUT}")
      set_tests_properties(${prefix}.shard${shard} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${timeout}
        ENVIRONMENT "GTEST_TOTAL_SHARDS=4;GTEST_SHARD_INDEX=${shard}")
    endforeach()
    return()
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${prefix}." DISCOVERY_TIMEOUT 60)
  # PROPERTIES of gtest_discover_tests cannot carry a list, so several labels are set when CTest has read the cases.
  set(file "${CMAKE_CURRENT_BINARY_DIR}/${target}_properties.cmake")
  file(CONFIGURE OUTPUT "${file}" @ONLY CONTENT [[
if(@target@_TESTS)
  set_tests_properties(${@target@_TESTS} PROPERTIES LABELS "@ARG_LABELS@" TIMEOUT @ARG_TIMEOUT@)
endif()
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${file}")
endfunction()

# tether_add_library(<name> SOURCES ... [PUBLIC ...] [PRIVATE ...] [TESTS ...] [TEST_LIBS ...]
#                    [TESTING_SOURCES ...] [LABELS ...])
#
# Declares a folder of common/, target/ or host/ as target tether_<name> (alias tether::<name>):
#   SOURCES         files below src/
#   PUBLIC/PRIVATE  what it links to; own libraries as tether::<lib>
#   TESTS           files below test/, one executable tether_<name>_test
#   TESTING_SOURCES fakes that other folders' tests use, as tether::<name>_testing, with headers in
#                   testing/include
#   LABELS          extra ctest labels of the tests ("threaded" ones run under tsan)
function(tether_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;TESTS;TEST_LIBS;TESTING_SOURCES;LABELS" ${ARGN})
  set(target tether_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_include_directories(${target} PUBLIC include PRIVATE src)
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} tether_compile_options)
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE include)
    target_link_libraries(${target} INTERFACE ${ARG_PUBLIC})
  endif()
  add_library(tether::${name} ALIAS ${target})

  if(NOT BUILD_TESTING)
    return()
  endif()
  _tether_check_headers(${target} "${CMAKE_CURRENT_SOURCE_DIR}/include")
  if(ARG_TESTING_SOURCES)
    add_library(${target}_testing STATIC ${ARG_TESTING_SOURCES})
    target_include_directories(${target}_testing PUBLIC testing/include)
    target_link_libraries(${target}_testing PUBLIC ${target} PRIVATE tether_compile_options)
    add_library(tether::${name}_testing ALIAS ${target}_testing)
  endif()
  if(ARG_TESTS)
    add_executable(${target}_test ${ARG_TESTS})
    target_include_directories(${target}_test PRIVATE src)
    target_link_libraries(${target}_test PRIVATE ${target} ${ARG_TEST_LIBS} ${ARG_PRIVATE}
      GTest::gmock GTest::gtest_main tether_test_options)
    if(ARG_TESTING_SOURCES)
      target_link_libraries(${target}_test PRIVATE ${target}_testing)
    endif()
    target_compile_definitions(${target}_test PRIVATE
      TETHER_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TETHER_TEST_DIR="${CMAKE_CURRENT_SOURCE_DIR}/test")
    _tether_register_test(${target}_test ${name} LABELS unit ${name} ${ARG_LABELS} TIMEOUT 300)
  endif()
endfunction()

# tether_add_test(<name> SOURCES ... [LIBS ...] LABELS ... [TIMEOUT <seconds>])
#
# A GoogleTest executable below tests/, target <name>_test. LABELS: "unit" (also run under asan+ubsan),
# "threaded" (also run under tsan), "system" (whole programs), "checked" (system tests that are run
# under asan+ubsan as well), ...
function(tether_add_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LIBS;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name}_test ${ARG_SOURCES})
  target_link_libraries(${name}_test PRIVATE ${ARG_LIBS} GTest::gmock GTest::gtest_main tether_test_options)
  target_compile_definitions(${name}_test PRIVATE
    TETHER_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TETHER_BINARY_DIR="${PROJECT_BINARY_DIR}"
    TETHER_TEST_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
  _tether_register_test(${name}_test ${name} LABELS ${ARG_LABELS} TIMEOUT ${ARG_TIMEOUT})
endfunction()

# tether_add_program(<name> SOURCES ... LIBS ... [COMPONENT <component>]): an executable of apps/, installed as part of
# that component: `tether` (the host; the default) or `tether-sut` (the target).
function(tether_add_program name)
  cmake_parse_arguments(ARG "" "COMPONENT" "SOURCES;LIBS" ${ARGN})
  if(NOT ARG_COMPONENT)
    set(ARG_COMPONENT tether)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} tether_compile_options)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${ARG_COMPONENT})
endfunction()
