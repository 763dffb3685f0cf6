// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds the palms of hands in images, by a small neural network (MediaPipe's palm detection).

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <hc/base/result.h>
#include <nets/network.h>
#include <people/hand.h>
#include <people/ssd.h>

namespace hc::people {

/// The palm of a hand.
struct Palm {
  /// In the order of the network's numbers: knuckles, and two joints of the thumb.
  enum Point { Wrist, Index, Middle, Ring, Little, Thumb, ThumbKnuckle };
  static constexpr std::size_t kPoints = ThumbKnuckle + 1;

  cv::Rect2f box;                           ///< without the fingers [px]
  float score = 0;                          ///< 0 … 1
  std::array<cv::Point2f, kPoints> points;  ///< [px]
};

/// Where to look for the points of the hand.
/// Source: MediaPipe, palm_detection_detection_to_roi.pbtxt.
Region region_of(const Palm& palm);

/// Finds palms.
///
/// Cost: 23 ms of one core.
class PalmFinder {
 public:
  /// @param network  palm_detection_lite.
  ///
  /// Errors: Malformed (its inputs and outputs are not those of such a network).
  static Result<PalmFinder> make(std::unique_ptr<nets::Network> network);

  /// The palms in a part of an image, which may extend beyond it, best first.
  /// @param image  (height, width) of u8, RGB or grey.
  /// @param least  of their scores.
  std::vector<Palm> find(const cv::Mat& image, const cv::Rect& part, float least = 0.5F);

 private:
  explicit PalmFinder(Ssd ssd) : ssd_(std::move(ssd)) {}

  Ssd ssd_;
};

}  // namespace hc::people
