# SPDX-License-Identifier: Apache-2.0
# What every leaf CMakeLists.txt is written with: hc_layer, hc_module, hc_test, hc_fuzz, hc_bench.

include(GNUInstallDirs)

option(HC_HEAD "Build the robot head: images, speech, sound, graphics, devices" ON)
option(HC_DEVELOPER_MODE "Build tests and benchmarks" OFF)
option(HC_WERROR "A warning is an error" OFF)
option(HC_COVERAGE "Count the lines that tests run" OFF)
set(HC_SANITIZE "" CACHE STRING "Sanitizers, such as address,undefined")
option(HC_LIBFUZZER "Link the fuzz targets with libFuzzer (clang)" OFF)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(HC_CCACHE ccache)
if(HC_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${HC_CCACHE})
endif()

find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_path(HC_TOML toml++/toml.h REQUIRED)
find_library(HC_zstd zstd)
find_library(HC_jpeg jpeg)
if(HC_HEAD)
  include(head_packages)
endif()

# Flags that are ours, not our users'.
add_library(hc_flags INTERFACE)
target_compile_options(hc_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion
                       # In a unity build the names of one file shadow those of another.
                       $<$<NOT:$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wshadow>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False for every "text" + std::string: https://gcc.gnu.org/bugzilla/show_bug.cgi?id=105651
  target_compile_options(hc_flags INTERFACE -Wno-restrict)
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # It is about headers, for which a .cpp of a unity build is taken.
  target_compile_options(hc_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()
if(HC_WERROR)
  target_compile_options(hc_flags INTERFACE -Werror)
endif()
# For the few tests that want to know where they are; others compile to the same in every checkout.
add_library(hc_paths INTERFACE)
target_compile_definitions(hc_paths INTERFACE HC_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                              HC_BINARY_DIR="${PROJECT_BINARY_DIR}")
add_custom_target(programs) # hc and the modules, without tests
if(HC_DEVELOPER_MODE)
  add_custom_target(fuzz_targets)
  enable_testing()
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
endif()
if(HC_SANITIZE)
  # UBSan's check of vptr asks the kernel for a pipe, and reports an error where there is none: where
  # tests let descriptors run out. AddressSanitizer finds what it would.
  add_compile_options(-fsanitize=${HC_SANITIZE} -fno-sanitize=vptr -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${HC_SANITIZE})
endif()
if(HC_LIBFUZZER)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
if(HC_COVERAGE)
  add_compile_options(--coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()

if(NOT HC_SANITIZE AND NOT HC_COVERAGE)
  # Hardening, of all that is built here; tests/install/hardening_test.py looks at what is installed.
  # Without optimisation glibc has no checks to fortify with.
  add_compile_options(-fstack-protector-strong $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE>
                      $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=2>)
  add_link_options(-Wl,-z,relro,-z,now)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES CXX)
endif()

set(HC_LIBEXEC ${CMAKE_INSTALL_LIBEXECDIR}/hypercolumn)
set(HC_TEST_SECONDS 120) # a test that takes longer hangs
set(HC_LIBRARY_SECONDS 900) # all tests of a library, which names the one that hangs: [ RUN ] is its last line
# What a sanitizer finds in other people's libraries is overlooked. ThreadSanitizer would have each
# process wait for a second at its end, which tests that start many, or measure, take for ours.
set(HC_TEST_ENVIRONMENT
    "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/leaks.supp:print_suppressions=0")
if(HC_SANITIZE MATCHES thread)
  set(HC_TEST_ENVIRONMENT "TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/races.supp:print_suppressions=0:die_after_fork=0:atexit_sleep_ms=0")
endif()

# hc_layer(mtp DEPENDS base HEADERS a.h SOURCES a.cpp TESTS a_test.cpp LIBS third::party TEST_LIBS gz)
# One layer of the core: target hc::mtp, its headers installed, its tests one program, mtp_test.
function(hc_layer name)
  cmake_parse_arguments(arg "" "SHARDS" "DEPENDS;HEADERS;SOURCES;TESTS;LIBS;PUBLIC_LIBS;TEST_LIBS" ${ARGN})
  set(target hc_${name})
  set(scope PUBLIC)
  if(arg_SOURCES)
    add_library(${target} STATIC ${arg_SOURCES})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:hc_flags> ${arg_LIBS})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(hc::${name} ALIAS ${target})
  list(TRANSFORM arg_DEPENDS PREPEND hc_)
  target_link_libraries(${target} ${scope} ${arg_DEPENDS} ${arg_PUBLIC_LIBS})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/lib
                                    FILES ${arg_HEADERS})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
  install(TARGETS ${target} EXPORT hypercolumn FILE_SET HEADERS)
  foreach(header ${arg_HEADERS})
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR}/lib ${CMAKE_CURRENT_SOURCE_DIR}/${header})
    set_property(GLOBAL APPEND_STRING PROPERTY HC_PUBLIC_HEADERS "${path}\n")
  endforeach()
  if(arg_TESTS)
    hc_test(${name}_test SOURCES ${arg_TESTS} LIBS hc::${name} ${arg_TEST_LIBS} SHARDS ${arg_SHARDS})
  endif()
endfunction()

# hc_test(mtp_test SOURCES a_test.cpp LIBS hc::mtp SHARDS 2)
# All cases of a library in one process, in any order, or in as many at once as there are shards, where
# they wait for long. build/tests/unit/mtp_test --gtest_filter=A.case runs one.
set(HC_LINK_CONFORMANCE ${PROJECT_SOURCE_DIR}/lib/hc/testing/link_conformance.cpp)
set(HC_SOCKET_LINK ${PROJECT_SOURCE_DIR}/lib/hc/testing/socket_link.cpp
                   ${PROJECT_SOURCE_DIR}/lib/hc/testing/reconnect.cpp)
function(hc_test name)
  if(NOT HC_DEVELOPER_MODE)
    return()
  endif()
  cmake_parse_arguments(arg "" "SHARDS" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE hc_flags ${arg_LIBS} GTest::gtest_main)
  # Most of what a build takes is tests.
  target_compile_options(${name} PRIVATE -O1)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/unit)
  if(NOT arg_SHARDS)
    set(arg_SHARDS 1)
  endif()
  foreach(shard RANGE 1 ${arg_SHARDS})
    set(test ${name})
    if(arg_SHARDS GREATER 1)
      set(test ${name}.${shard})
    endif()
    math(EXPR index "${shard} - 1")
    add_test(NAME ${test} COMMAND ${name})
    set_tests_properties(${test} PROPERTIES TIMEOUT ${HC_LIBRARY_SECONDS} ENVIRONMENT
      "${HC_TEST_ENVIRONMENT};GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()

# hc_module(depth LIBS hc::opencv hc::vision)
# A module: main.cpp; a library of program.cpp, depth.cpp, where they exist, and SOURCES; depth_test.cpp
# and TESTS, which are in the program modules_test with those of other modules; and cases/. Not built
# where one of LIBS is missing (HC_HEAD), not installed where it is TEST_ONLY.
function(hc_module name)
  cmake_parse_arguments(arg "TEST_ONLY" "" "SOURCES;TESTS;LIBS" ${ARGN})
  foreach(lib ${arg_LIBS})
    if(NOT TARGET ${lib} AND (lib MATCHES "::" OR lib MATCHES "^opencv_"))
      return()
    endif()
  endforeach()
  foreach(source program ${name})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${source}.cpp)
      list(APPEND arg_SOURCES ${source}.cpp)
    endif()
  endforeach()
  if(arg_SOURCES)
    add_library(module_${name}_parts STATIC ${arg_SOURCES})
    target_link_libraries(module_${name}_parts PRIVATE hc_flags hc::module ${arg_LIBS})
    list(APPEND arg_LIBS module_${name}_parts)
  endif()
  add_executable(module_${name} main.cpp)
  set(folder libexec/hypercolumn)
  if(arg_TEST_ONLY)
    set(folder tests/programs)
  endif()
  set_target_properties(module_${name} PROPERTIES
    OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${folder} UNITY_BUILD OFF)
  target_link_libraries(module_${name} PRIVATE hc_flags hc::module hc::transports ${arg_LIBS})
  if(NOT arg_TEST_ONLY)
    install(TARGETS module_${name} DESTINATION ${HC_LIBEXEC})
    add_dependencies(programs module_${name})
  endif()
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp)
    list(APPEND arg_TESTS ${name}_test.cpp)
  endif()
  if(arg_TESTS)
    list(TRANSFORM arg_TESTS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    set_property(GLOBAL APPEND PROPERTY HC_MODULE_TESTS ${arg_TESTS})
    set_property(GLOBAL APPEND PROPERTY HC_MODULE_TEST_LIBS hc::module ${arg_LIBS})
  endif()
  hc_cases(${name})
endfunction()

# The program of all tests of modules, once all modules are known.
function(hc_module_tests)
  get_property(tests GLOBAL PROPERTY HC_MODULE_TESTS)
  get_property(libs GLOBAL PROPERTY HC_MODULE_TEST_LIBS)
  list(REMOVE_DUPLICATES libs)
  hc_test(modules_test SOURCES ${tests} LIBS ${libs})
endfunction()

# hc_programs_of(VARIABLE graphs/head.toml): the programs that a graph file starts, and files it includes.
function(hc_programs_of variable file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(STRINGS ${file} lines REGEX "^(\\[modules|program = |file = )")
  set(programs)
  foreach(line ${lines})
    if(line MATCHES "^\\[modules\\.([a-z0-9_]+)\\]")
      list(APPEND programs ${CMAKE_MATCH_1})
    elseif(line MATCHES "^program = \"([a-z0-9_]+)\"")
      list(POP_BACK programs)
      list(APPEND programs ${CMAKE_MATCH_1})
    elseif(line MATCHES "^file = \"[^\"]*[^a-z_\"]([a-z_]+\\.toml)|^file = \"([a-z_]+\\.toml)")
      cmake_path(GET file PARENT_PATH folder)
      hc_programs_of(included ${folder}/${CMAKE_MATCH_1}${CMAKE_MATCH_2})
      list(APPEND programs ${included})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES programs)
  set(${variable} ${programs} PARENT_SCOPE)
endfunction()

# Every folder of cases/ here is a test: the command in `cmd`, fed with `in`, prints `out`.
function(hc_cases name)
  if(NOT HC_DEVELOPER_MODE)
    return()
  endif()
  file(GLOB cases CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/cases/*/cmd)
  foreach(cmd ${cases})
    cmake_path(GET cmd PARENT_PATH folder)
    cmake_path(GET folder FILENAME case)
    add_test(NAME case.${name}.${case}
             COMMAND ${PROJECT_SOURCE_DIR}/scripts/run_case ${PROJECT_BINARY_DIR} ${folder})
    set_tests_properties(case.${name}.${case} PROPERTIES TIMEOUT ${HC_TEST_SECONDS}
                         ENVIRONMENT "${HC_TEST_ENVIRONMENT}")
  endforeach()
endfunction()

# hc_fuzz(header LIBS hc::mtp): fuzz_header() of tests/fuzz/header.cpp, a fuzzer where libFuzzer is
# linked, and in every other build a test that replays tests/fuzz/corpus/header.
function(hc_fuzz name)
  cmake_parse_arguments(arg "" "" "LIBS" ${ARGN})
  set(program fuzz_replay)
  set(options ${name})
  if(HC_LIBFUZZER)
    set(entry ${CMAKE_CURRENT_BINARY_DIR}/${name}_entry.cpp)
    configure_file(entry.cpp.in ${entry} @ONLY)
    set(program fuzz_${name})
    set(options -runs=0)
    add_executable(${program} ${name}.cpp ${entry})
    target_link_libraries(${program} PRIVATE hc_flags ${arg_LIBS})
    target_link_options(${program} PRIVATE -fsanitize=fuzzer)
    add_dependencies(fuzz_targets ${program})
    set_target_properties(${program} PROPERTIES
      RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz OUTPUT_NAME ${name})
  else()
    set_property(GLOBAL APPEND PROPERTY HC_FUZZ_NAMES ${name})
    set_property(GLOBAL APPEND PROPERTY HC_FUZZ_LIBS ${arg_LIBS})
  endif()
  add_test(NAME fuzz.${name} COMMAND ${program} ${options} ${CMAKE_CURRENT_SOURCE_DIR}/corpus/${name})
  set_tests_properties(fuzz.${name} PROPERTIES TIMEOUT ${HC_TEST_SECONDS}
                       ENVIRONMENT "${HC_TEST_ENVIRONMENT}")
endfunction()

# The one program that replays the corpus of every target, where there is no libFuzzer.
function(hc_fuzz_replay)
  if(HC_LIBFUZZER)
    return()
  endif()
  get_property(names GLOBAL PROPERTY HC_FUZZ_NAMES)
  get_property(libs GLOBAL PROPERTY HC_FUZZ_LIBS)
  list(REMOVE_DUPLICATES libs)
  list(TRANSFORM names PREPEND fuzz_ OUTPUT_VARIABLE functions)
  list(JOIN functions ", " functions)
  list(TRANSFORM names REPLACE "(.+)" "{\"\\1\", fuzz_\\1}" OUTPUT_VARIABLE targets)
  list(JOIN targets ", " targets)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/replay.cpp)
  configure_file(replay.cpp.in ${source} @ONLY)
  list(TRANSFORM names APPEND .cpp)
  add_executable(fuzz_replay ${source} ${names})
  target_link_libraries(fuzz_replay PRIVATE hc_flags ${libs})
endfunction()

# hc_bench(mtp LIBS hc::mtp): build/bench/mtp of mtp.cpp, unless OUTPUT and SOURCE say otherwise.
function(hc_bench name)
  cmake_parse_arguments(arg "" "OUTPUT;SOURCE" "LIBS" ${ARGN})
  if(NOT arg_OUTPUT)
    set(arg_OUTPUT ${name})
  endif()
  if(NOT arg_SOURCE)
    set(arg_SOURCE ${name}.cpp)
  endif()
  add_executable(bench_${name} ${arg_SOURCE})
  target_link_libraries(bench_${name} PRIVATE hc_flags ${arg_LIBS})
  set_target_properties(bench_${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bench OUTPUT_NAME ${arg_OUTPUT})
endfunction()

# The package that other projects find: find_package(hypercolumn), hypercolumn::hc or one layer.
function(hc_install_package)
  add_library(hc_all INTERFACE)
  set_target_properties(hc_all PROPERTIES EXPORT_NAME hc)
  target_link_libraries(hc_all INTERFACE hc_base hc_os hc_mtp hc_compress hc_link hc_transports hc_module)
  install(TARGETS hc_all EXPORT hypercolumn)
  get_property(headers GLOBAL PROPERTY HC_PUBLIC_HEADERS)
  file(CONFIGURE OUTPUT public_headers.txt CONTENT "${headers}" @ONLY)  # for scripts/build_docs
  set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/hypercolumn)
  install(EXPORT hypercolumn NAMESPACE hypercolumn:: DESTINATION ${folder}
          FILE hypercolumn-targets.cmake)
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/hypercolumn-config-version.cmake
                                   COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/hypercolumn-config.cmake
                ${PROJECT_BINARY_DIR}/hypercolumn-config-version.cmake DESTINATION ${folder})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/share/hypercolumn)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/graphs ${PROJECT_BINARY_DIR}/share/hypercolumn/graphs SYMBOLIC)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/graphs DESTINATION ${CMAKE_INSTALL_DATADIR}/hypercolumn)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian_copyright RENAME copyright
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/hypercolumn)
  install(FILES ${PROJECT_SOURCE_DIR}/spec/mtp-1.md ${PROJECT_SOURCE_DIR}/spec/message.idl
          DESTINATION ${CMAKE_INSTALL_DATADIR}/hypercolumn/spec)
endfunction()

# build/hypercolumn_VERSION_ARCH.deb, by ./dev package.
function(hc_package_deb)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME hypercolumn)
  set(CPACK_PACKAGE_CONTACT "Hypercolumn maintainers <maintainers@localhost>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Modules and graphs for cognitive robots, over one message format")
  set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  # What `hc new` and find_package() want beside the package: a compiler, and the headers of our headers.
  set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, make, libeigen3-dev")
  # What no library says that it needs: voices, a dictionary of letters, drawing without a GPU, arrays in
  # Python.
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "espeak-ng-data, tesseract-ocr-eng, libgl1-mesa-dri, fonts-dejavu-core, python3-numpy")
  include(CPack)
endfunction()
