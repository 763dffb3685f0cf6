// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shows images in windows and saves them as files. Blue, green, red, as in OpenCV.

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// The windows of a program on the display of its session. For one thread.
class Display {
 public:
  /// @param monitor  index of the monitor to fill; below 0 the windows are ordinary ones.
  /// Errors: Unsupported (no display, or no such monitor).
  static Result<std::unique_ptr<Display>> open(int monitor = -1);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  /// Shows an image, (H, W) or (H, W, 3) u8, scaled to the window of that title. Opens the window
  /// if needed, and does nothing after the user closed it.
  /// Cost: waits for the display's next refresh.
  void show(const std::string& title, const cv::Mat& bgr);

  /// Handles events. @returns  whether any window is still open; a key closes all.
  bool any_open();

  /// The size of the monitor that windows fill [px]; empty for ordinary windows.
  [[nodiscard]] cv::Size monitor_size() const { return monitor_size_; }

 private:
  struct Window;
  explicit Display(int monitor, cv::Size size);

  int monitor_;
  cv::Size monitor_size_;
  std::map<std::string, Window> windows_;
};

/// Replaces an image file atomically. Creates its folder if needed.
/// Errors: System (it cannot be written).
Status save_image(const std::filesystem::path& path, const cv::Mat& bgr);

}  // namespace hc::vision
