# The one way a library, a program or a test of Tether is declared, so that compiler settings, folder
# rules and header checks are the same everywhere.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

option(TETHER_WARNINGS_AS_ERRORS "Treat every compiler warning as an error" ON)
set(TETHER_SANITIZE "" CACHE STRING "Sanitizers for -fsanitize=, e.g. address,undefined")
set(TETHER_OPTIMISE_BUSY "" CACHE STRING "How libraries that are BUSY are optimised where others are not, e.g. -O1")
set(TETHER_OPTIMISE_IDLE "" CACHE STRING "How the host's libraries that are not BUSY are optimised, e.g. -Og")

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

# GCC spends a tenth of its time looking for memory to free, which in these units is less than 1 GB.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options(--param=ggc-min-heapsize=1000000)
endif()

# The linker that takes a tenth of the time, where there is one for this target.
find_program(TETHER_MOLD mold)
mark_as_advanced(TETHER_MOLD)
if(TETHER_MOLD AND NOT CMAKE_CROSSCOMPILING)
  add_link_options(-fuse-ld=mold)
endif()

# Each public header is compiled alone, so that it includes all it needs.
function(_tether_check_headers target include_dir)
  if(CMAKE_UNITY_BUILD)
    return()  # they would be one file, in which the first include serves them all
  endif()
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

# What nearly every library includes is compiled once. Not with a cache of compiled files (ccache), which finds less
# that way; nor in `dev`, which finds what a file forgot to include.
function(_tether_add_library_headers target)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/library_headers.cpp" CONTENT "\n")
  add_library(${target} STATIC EXCLUDE_FROM_ALL "${PROJECT_BINARY_DIR}/library_headers.cpp")
  target_link_libraries(${target} PRIVATE tether_compile_options)
  target_compile_options(${target} PRIVATE ${ARGN})
  target_precompile_headers(${target} PRIVATE
    <algorithm> <array> <atomic> <chrono> <cmath> <condition_variable> <filesystem> <fstream> <functional> <map> <memory>
    <mutex> <optional> <ranges> <set> <span> <sstream> <stop_token> <string> <thread> <variant> <vector>)
endfunction()
if(CMAKE_UNITY_BUILD AND BUILD_TESTING AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  _tether_add_library_headers(tether_library_headers)
  if(TETHER_OPTIMISE_IDLE)
    _tether_add_library_headers(tether_idle_library_headers ${TETHER_OPTIMISE_IDLE} -Wno-maybe-uninitialized)
  endif()
endif()

# tether_optimise(<target> [BUSY | SHIPPED | IDLE]): what is compiled for the host, and does not compute for long, need not
# be fast in a test, nor need a library of tests (IDLE). What runs on the target is as shipped: a test of counted work
# counts it. SHIPPED is BUSY, except under the sanitizers of each change: there, to optimise it takes longer than its
# tests gain.
function(tether_optimise target)
  if(ARGN STREQUAL "BUSY" OR (ARGN STREQUAL "SHIPPED" AND TETHER_SANITIZE MATCHES "fuzzer"))
    set(busy ${TETHER_OPTIMISE_BUSY})
  elseif(ARGN STREQUAL "IDLE" OR (NOT ARGN AND CMAKE_CURRENT_SOURCE_DIR MATCHES "/(host|apps/tether)(/|$)"))
    set(idle ${TETHER_OPTIMISE_IDLE})
  endif()
  if(busy)
    target_compile_options(${target} PRIVATE ${busy})
  elseif(idle)
    # Optimised that little, the standard library's own code sets this warning off.
    target_compile_options(${target} PRIVATE ${TETHER_OPTIMISE_IDLE} -Wno-maybe-uninitialized)
    if(TARGET tether_idle_library_headers)
      target_precompile_headers(${target} REUSE_FROM tether_idle_library_headers)
    endif()
  elseif(TARGET tether_library_headers)
    target_precompile_headers(${target} REUSE_FROM tether_library_headers)
  endif()
endfunction()

# What must be there before a source can be read (scripts/tidy).
add_custom_target(tether_generated)

# What each kind of test run has to build, so that it compiles nothing that it does not run.
foreach(kind IN ITEMS unit input_unit threaded_unit threaded_full_unit checked_system threaded_system)
  add_custom_target(tether_${kind}_tests)
endforeach()

# Tests are half of all that is compiled. What nearly every one includes is compiled once, in a program, whose
# code is compiled as theirs is; and only what they test is optimised.
add_library(tether_test_options INTERFACE)
target_compile_options(tether_test_options INTERFACE $<$<CONFIG:RelWithDebInfo>:-Og> $<$<CONFIG:Debug>:-O0>
  # Fuzzing follows what an input reaches in the product, and no unit test is part of it.
  $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=fuzzer-no-link>
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

# Registers a GoogleTest executable with CTest, as one entry: loading libraries and flying what a fixture flies costs
# more than most cases. Its cases with their times are in test-results/<entry>.xml.
#   LABELS   see tether_add_test
#   TIMEOUT  seconds for the whole entry
#   COST     see tether_add_test
#   SERIAL   see tether_add_test; they become an entry of their own, with the label "alone" in place of "system"
#   EVERY_CHANGE  of a test with the label "full": the cases (a --gtest_filter) that each change runs all the same
#   CASES    which cases of the program the entry has (a --gtest_filter of suites); all by default
function(_tether_register_test target name)
  cmake_parse_arguments(ARG "" "TIMEOUT;EVERY_CHANGE;SERIAL;COST;CASES" "LABELS" ${ARGN})
  if(NOT ARG_COST)
    set(ARG_COST 0)
  endif()
  if("unit" IN_LIST ARG_LABELS)
    add_dependencies(tether_unit_tests ${target})
    set(level unit)
  else()
    set(level system)
  endif()
  foreach(label IN LISTS ARG_LABELS)
    if(TARGET tether_${label}_${level}_tests)
      add_dependencies(tether_${label}_${level}_tests ${target})
    endif()
  endforeach()
  if(ARG_EVERY_CHANGE)
    _tether_add_test_entry(${target} ${name}.full "${ARG_CASES}-${ARG_EVERY_CHANGE}" "${ARG_LABELS}" ${ARG_TIMEOUT} ${ARG_COST})
    list(REMOVE_ITEM ARG_LABELS full)
  endif()
  if(NOT ARG_EVERY_CHANGE)
    set(ARG_EVERY_CHANGE "${ARG_CASES}")
  endif()
  if(ARG_SERIAL)
    set(labels ${ARG_LABELS})
    list(TRANSFORM labels REPLACE "^system$" alone)
    _tether_add_test_entry(${target} ${name}.alone "${ARG_SERIAL}" "${labels}" ${ARG_TIMEOUT} 0)
    set_tests_properties(${name}.alone PROPERTIES RUN_SERIAL TRUE)
    set(ARG_EVERY_CHANGE "${ARG_CASES}-${ARG_SERIAL}")
  endif()
  _tether_add_test_entry(${target} ${name} "${ARG_EVERY_CHANGE}" "${ARG_LABELS}" ${ARG_TIMEOUT} ${ARG_COST})
endfunction()

function(_tether_add_test_entry target entry filter labels timeout cost)
  if(filter)
    list(APPEND options "--gtest_filter=${filter}")
  endif()
  add_test(NAME ${entry} COMMAND ${target} --gtest_brief=1
    "--gtest_output=xml:${PROJECT_BINARY_DIR}/test-results/${entry}.xml" ${options})
  set_tests_properties(${entry} PROPERTIES LABELS "${labels}" TIMEOUT ${timeout} COST ${cost}
    ENVIRONMENT "TETHER_CACHE=${PROJECT_BINARY_DIR}/world-cache")
endfunction()

# tether_add_library(<name> SOURCES ... [PUBLIC ...] [PRIVATE ...] [TESTS ...] [TEST_LIBS ...]
#                    [TESTING_SOURCES ...] [LABELS ...] [COST <seconds>] [OPTIMISE <kind>] [OPTIMISE_TESTING <kind>])
#
# Declares a folder of common/, target/ or a wing of host/ as target tether_<name> (alias tether::<name>):
#   SOURCES         files below src/
#   PUBLIC/PRIVATE  what it links to; own libraries as tether::<lib>
#   TESTS           files below test/, one executable tether_<name>_test
#   TESTING_SOURCES fakes that other folders' tests use, as tether::<name>_testing, with headers in
#                   testing/include
#   LABELS, COST    of the tests: extra labels input and threaded; see tether_add_test
#   OPTIMISE, OPTIMISE_TESTING   its tests, or its fakes (IDLE by default), compute for long: see tether_optimise
function(tether_add_library name)
  cmake_parse_arguments(ARG "" "COST;OPTIMISE;OPTIMISE_TESTING" "SOURCES;PUBLIC;PRIVATE;TESTS;TEST_LIBS;TESTING_SOURCES;LABELS" ${ARGN})
  set(target tether_${name})
  if(NOT ARG_OPTIMISE_TESTING)
    set(ARG_OPTIMISE_TESTING IDLE)
  endif()
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_include_directories(${target} PUBLIC include PRIVATE src)
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} tether_compile_options)
    tether_optimise(${target} ${ARG_OPTIMISE})
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
    tether_optimise(${target}_testing ${ARG_OPTIMISE_TESTING})
    add_library(tether::${name}_testing ALIAS ${target}_testing)
  endif()
  if(ARG_TESTS)
    add_executable(${target}_test ${ARG_TESTS})
    target_precompile_headers(${target}_test REUSE_FROM tether_test_headers)
    target_include_directories(${target}_test PRIVATE src test)
    target_link_libraries(${target}_test PRIVATE ${target} ${ARG_TEST_LIBS} ${ARG_PRIVATE}
      GTest::gmock GTest::gtest_main tether_test_options)
    if(ARG_TESTING_SOURCES)
      target_link_libraries(${target}_test PRIVATE ${target}_testing)
    endif()
    target_compile_definitions(${target}_test PRIVATE
      TETHER_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TETHER_TEST_DIR="${CMAKE_CURRENT_SOURCE_DIR}/test")
    _tether_register_test(${target}_test ${name} LABELS unit ${ARG_LABELS} TIMEOUT 600 COST "${ARG_COST}")
  endif()
endfunction()

# tether_add_test_program(<target> [SOURCES ...] [LIBS ...]): a GoogleTest executable below tests/.
function(tether_add_test_program target)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  target_precompile_headers(${target} REUSE_FROM tether_test_headers)
  target_link_libraries(${target} PRIVATE ${ARG_LIBS} GTest::gmock GTest::gtest_main tether_test_options)
  target_compile_definitions(${target} PRIVATE
    TETHER_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TETHER_BINARY_DIR="${PROJECT_BINARY_DIR}"
    TETHER_TEST_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
endfunction()

# tether_add_test(<name> SOURCES ... [LIBS ...] LABELS ... [TIMEOUT <seconds>] [COST <seconds>] [SERIAL <filter>] [EVERY_CHANGE <filter>])
#
# COST is what it takes, roughly, where that is long: long ones start first, so that none of them runs last and alone.
# SERIAL are the cases (a --gtest_filter) beside which nothing may run, because their pace matters.
# A GoogleTest executable below tests/, target <name>_test. LABELS say when it runs (CONTRIBUTING, "Which test runs where"):
#   unit      first; in `scripts/test --full` under asan and ubsan as well
#   system    whole programs
#   input     unit tests of what reads what others wrote or sent: under asan and ubsan at each change
#   threaded  unit tests of what starts threads: under tsan as well; a system test with --full only
#   threaded_full   the same with --full only: what is built on the libraries with the label threaded
#   checked   a system test that runs under asan and ubsan as well, with --full
#   board, arm64, gazebo   needs this part; not in `scripts/test --quick`
#   full      in `scripts/test --full` only, but for the cases of EVERY_CHANGE
function(tether_add_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT;COST;SERIAL;EVERY_CHANGE" "SOURCES;LIBS;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  tether_add_test_program(${name}_test SOURCES ${ARG_SOURCES} LIBS ${ARG_LIBS})
  _tether_register_test(${name}_test ${name} LABELS ${ARG_LABELS} TIMEOUT ${ARG_TIMEOUT}
    COST "${ARG_COST}" SERIAL "${ARG_SERIAL}" EVERY_CHANGE "${ARG_EVERY_CHANGE}")
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
