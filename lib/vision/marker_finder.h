// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds markers of each kind in images. No messages. A finder belongs to one thread.

#include <cstddef>
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
  /// Errors: Invalid (an unknown dictionary).
  static Result<ArucoFinder> make(const std::string& dictionary);

  /// Whether the dictionary has so many markers. Errors: Invalid (it has fewer).
  [[nodiscard]] Status has(std::size_t markers) const;
  /// What is inside the black border of a marker: (N, N) u8, a pixel a cell, 0 or 255.
  [[nodiscard]] cv::Mat cells(int id) const;

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
  /// @param wide_borders  find tags with a black border of two cells as well, as Kalibr prints
  /// them.
  explicit AprilTagFinder(double decimate, bool wide_borders = false);

  /// @param grey  (H, W) u8.
  /// Cost: 20 to 35 ms at 800×600 and decimate 1.
  [[nodiscard]] std::vector<Marker> find(const cv::Mat& grey) const;

 private:
  struct Detector;
  std::shared_ptr<Detector> detector_;
};

/// What is inside the black border of an AprilTag (36h11): (6, 6) u8, a pixel a cell, 0 or 255.
cv::Mat apriltag_cells(int id);

/// Filled squares of one saturated colour on white. The rotation of a square is ambiguous: top left
/// is the corner that gives the least rotation.
///
/// @param rgb  (H, W, 3) u8.
/// Cost: 2 to 4 ms at 800×600.
std::vector<Marker> find_colour_markers(const cv::Mat& rgb);

}  // namespace hc::vision
