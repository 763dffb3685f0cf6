# SPDX-License-Identifier: Apache-2.0
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 NO_MODULE)
find_package(nlohmann_json QUIET) # for hypercolumn::graph alone
include(${CMAKE_CURRENT_LIST_DIR}/hypercolumn-targets.cmake)
