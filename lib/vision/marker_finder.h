// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds markers of each kind in images. No messages. A finder belongs to one thread.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <vision/marker.h>

namespace hc::vision {

/// ArUco markers of one dictionary.
class ArucoFinder {
 public:
  /// @param dictionary  as OpenCV names it, without DICT_: "4X4_50", "6X6_250", "ARUCO_ORIGINAL".
  ///
  /// Errors: NotFound.
  static Result<ArucoFinder> make(const std::string& dictionary);

  /// @param grey  (H, W) u8.
  /// Cost: 5 ms at 800×600.
  [[nodiscard]] std::vector<Marker> find(const cv::Mat& grey) const;

 private:
  struct Detector;
  explicit ArucoFinder(std::shared_ptr<const Detector> detector) : detector_(std::move(detector)) {}
  std::shared_ptr<const Detector> detector_;
};

/// AprilTags of the family tag36h11.
class AprilTagFinder {
 public:
  /// @param decimate  edges are looked for in an image so many times smaller: 1 finds the most, 2
  ///     takes a third of the time. [1]
  explicit AprilTagFinder(double decimate);

  /// @param grey  (H, W) u8.
  /// Cost: 20 to 35 ms at 800×600 and decimate 1.
  [[nodiscard]] std::vector<Marker> find(const cv::Mat& grey) const;

 private:
  struct Detector;
  std::shared_ptr<Detector> detector_;
};

/// Filled squares of one saturated colour on white. The square does not show its rotation, so
/// that top left is the corner for which the marker is turned least.
///
/// @param rgb  (H, W, 3) u8.
/// Cost: 2 to 4 ms at 800×600.
std::vector<Marker> find_colour_markers(const cv::Mat& rgb);

}  // namespace hc::vision
