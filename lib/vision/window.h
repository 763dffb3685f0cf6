// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where images are shown and saved for people. Blue, green, red, as OpenCV has them.

#include <filesystem>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// Whether a window can be opened. OpenCV's window library aborts the program where a display is
/// named but does not answer, so a child process tries first.
bool has_display();

/// Replaces an image file at once: a reader finds the previous image or this one, whole. Makes its
/// folder where there is none.
/// Errors: System (it cannot be written).
Status save_image(const std::filesystem::path& path, const cv::Mat& bgr);

}  // namespace hc::vision
