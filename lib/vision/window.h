// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where images are shown and saved for people. Blue, green, red, as OpenCV has them.

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// The windows of a program, on the display of its session. For one thread.
class Display {
 public:
  /// @param monitor  windows fill it, 0 the first; below 0 they are windows among others.
  /// Errors: Unsupported (there is no display, or no such monitor).
  static Result<std::unique_ptr<Display>> open(int monitor = -1);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  /// Shows an image, (H, W) or (H, W, 3) u8, in the window of that title; opens it if there is
  /// none, and does nothing after a person has closed it. The image is scaled to the window.
  /// Cost: waits for the display's next refresh.
  void show(const std::string& title, const cv::Mat& bgr);

  /// Handles what people did. @returns  whether any window is open still; a key closes all.
  bool any_open();

  /// The size of the monitor that windows fill [px]; empty where they do not.
  [[nodiscard]] cv::Size monitor_size() const { return monitor_size_; }

 private:
  struct Window;
  explicit Display(int monitor, cv::Size size);

  int monitor_;
  cv::Size monitor_size_;
  std::map<std::string, Window> windows_;
};

/// Replaces an image file at once: a reader finds the previous image or this one, whole. Makes its
/// folder where there is none.
/// Errors: System (it cannot be written).
Status save_image(const std::filesystem::path& path, const cv::Mat& bgr);

}  // namespace hc::vision
