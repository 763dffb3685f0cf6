# SPDX-License-Identifier: Apache-2.0
# What the robot head is built with, beside what the core needs (scripts/packages/core.txt).

find_library(HC_zstd zstd REQUIRED)
find_library(HC_jpeg jpeg REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(assimp REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(highway REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(sdl2 REQUIRED IMPORTED_TARGET sdl2)
pkg_check_modules(tesseract REQUIRED IMPORTED_TARGET tesseract)
pkg_check_modules(espeak REQUIRED IMPORTED_TARGET espeak-ng)
pkg_check_modules(aravis REQUIRED IMPORTED_TARGET aravis-0.8)
pkg_check_modules(apriltag REQUIRED IMPORTED_TARGET apriltag)
pkg_check_modules(vpx REQUIRED IMPORTED_TARGET vpx)
pkg_check_modules(qrencode REQUIRED IMPORTED_TARGET libqrencode)
find_package(OpenSSL REQUIRED)
find_package(CycloneDDS REQUIRED)
find_path(HC_BOOST boost/beast.hpp REQUIRED) # header files alone
find_program(HC_NPM npm REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)

# Debian's single OpenCV packages have no CMake package, which is libopencv-dev's with everything.
find_path(HC_OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(module core imgproc imgcodecs videoio calib3d aruco freetype video dnn)
  find_library(HC_OPENCV_${module} opencv_${module} REQUIRED)
  add_library(opencv_${module} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(opencv_${module} PROPERTIES
    IMPORTED_LOCATION ${HC_OPENCV_${module}} INTERFACE_INCLUDE_DIRECTORIES ${HC_OPENCV_INCLUDE})
  if(NOT module STREQUAL core)
    target_link_libraries(opencv_${module} INTERFACE opencv_core)
  endif()
endforeach()
# From OpenCV 4.7 on most of ArUco is in another library, which comes with the package of contrib's.
if(EXISTS ${HC_OPENCV_INCLUDE}/opencv2/objdetect/aruco_detector.hpp)
  find_library(HC_OPENCV_objdetect opencv_objdetect REQUIRED)
  target_link_libraries(opencv_aruco INTERFACE ${HC_OPENCV_objdetect})
endif()
