// SPDX-License-Identifier: Apache-2.0
#pragma once
// Keeps OpenCV from printing.

#include <cstdlib>

#include <opencv2/core/utils/logger.hpp>

namespace hc::vision {

/// Keeps OpenCV, and FFmpeg in it, from printing lines of their own about files and cameras: a
/// module logs what fails itself. For the start of a program that reads such. OPENCV_LOG_LEVEL and
/// OPENCV_FFMPEG_LOGLEVEL in the environment take precedence.
inline void hush_opencv() {
  using namespace cv::utils::logging;
  if (std::getenv("OPENCV_LOG_LEVEL") == nullptr) setLogLevel(LOG_LEVEL_SILENT);
  constexpr const char* kQuiet = "-8";  // AV_LOG_QUIET
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", kQuiet, 0);
}

}  // namespace hc::vision
