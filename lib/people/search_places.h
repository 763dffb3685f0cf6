// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where to search for the palms of hands. Pure.

#include <cstddef>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <people/image_changes.h>

namespace hc::people {

/// Chooses where to search next, in turn: around the face around which the image has changed most,
/// since a palm that is raised changes it; around the face that was chosen longest ago; and in all
/// of the image or one of its parts.
class SearchPlaces {
 public:
  /// Takes the next image. @see ImageChanges::add()
  void add(const cv::Mat& image) { changes_.add(image); }
  /// The next place, which may extend beyond the image.
  /// @param image  its size. @param faces  boxes of the faces in view.
  cv::Rect next(const cv::Size& image, const std::vector<cv::Rect2f>& faces);

 private:
  // Since searches around faces: far hands are too small in the image and its parts.
  ImageChanges changes_;
  std::size_t turn_ = 0, next_part_ = 0;
};

}  // namespace hc::people
