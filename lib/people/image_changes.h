// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where images have changed since they were searched there. Pure.

#include <opencv2/core/mat.hpp>

namespace hc::people {

/// Accumulates the change of each part of an image, so that a search can look where somebody has
/// moved; a camera that turns changes all of it.
///
/// Cost: 1 ms for an SVGA image.
class ImageChanges {
 public:
  /// Takes the next image, (height, width) of u8, RGB or grey. An image of another size
  /// resets everything.
  void add(const cv::Mat& image);
  /// The mean change in a part since it was searched, of the levels of grey. 0 outside.
  /// @param part  [px]
  [[nodiscard]] double change(const cv::Rect& part) const;
  /// How many images have come since the age of a part was reset, on average over it. 0 outside.
  [[nodiscard]] double age(const cv::Rect& part) const;
  /// Resets the change of a part, when it is searched.
  void forget_change(const cv::Rect& part);
  /// Resets the age of a part.
  void forget_age(const cv::Rect& part);

 private:
  /// A part in the coarse images.
  [[nodiscard]] cv::Rect coarse(const cv::Rect& part) const;

  cv::Size size_;       // of the images
  cv::Mat last_;        // coarse, grey
  cv::Mat sum_, ages_;  // f32
};

}  // namespace hc::people
