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
  /// @param dictionary  OpenCV's name without DICT_: "4X4_50", "6X6_250", "ARUCO_ORIGINAL".
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
  /// @param decimate  edges are searched in an image reduced by this factor [1]: 1 finds the most,
  ///     2 takes a third of the time.
  explicit AprilTagFinder(double decimate);

  /// @param grey  (H, W) u8.
  /// Cost: 20 to 35 ms at 800×600 and decimate 1.
  [[nodiscard]] std::vector<Marker> find(const cv::Mat& grey) const;

 private:
  struct Detector;
  std::shared_ptr<Detector> detector_;
};

/// Filled squares of one saturated colour on white. The rotation of a square is ambiguous: top left
/// is the corner that gives the least rotation.
///
/// @param rgb  (H, W, 3) u8.
/// Cost: 2 to 4 ms at 800×600.
std::vector<Marker> find_colour_markers(const cv::Mat& rgb);

}  // namespace hc::vision
