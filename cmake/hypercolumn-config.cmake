# SPDX-License-Identifier: Apache-2.0
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 NO_MODULE)
find_dependency(PkgConfig)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(jpeg REQUIRED IMPORTED_TARGET libjpeg)
include(${CMAKE_CURRENT_LIST_DIR}/hypercolumn-targets.cmake)
