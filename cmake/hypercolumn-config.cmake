# SPDX-License-Identifier: Apache-2.0
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 NO_MODULE)
find_dependency(PkgConfig)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(jpeg REQUIRED IMPORTED_TARGET libjpeg)
# Only hypercolumn::graph needs these.
pkg_check_modules(tomlplusplus QUIET IMPORTED_TARGET tomlplusplus)
find_package(nlohmann_json QUIET)
include(${CMAKE_CURRENT_LIST_DIR}/hypercolumn-targets.cmake)
