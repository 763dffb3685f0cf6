// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds the points of a hand, by a small neural network (MediaPipe's hand landmarks).

#include <memory>

#include <opencv2/core/mat.hpp>

#include <hc/base/result.h>
#include <nets/network.h>
#include <people/hand.h>

namespace hc::people {

/// Finds the points of a hand in a region of an image.
///
///     Hand hand = landmarks->find(image, region_of(palm));
///     if (hand.presence >= kHandIsThere) … region_of(hand) in the next image
///
/// Cost: 15 ms of one core.
class HandLandmarks {
 public:
  /// @param network  hand_landmark_lite.
  ///
  /// Errors: Malformed (its inputs and outputs are not those of such a network).
  static Result<HandLandmarks> make(std::unique_ptr<nets::Network> network);

  /// @param image  (height, width) of u8, RGB or grey, not mirrored.
  /// @param region  with the wrist below and the fingers above; may extend beyond the image.
  /// @returns  finite numbers; a presence of 0 where the network's are not, or are no hand's.
  Hand find(const cv::Mat& image, const Region& region);

 private:
  explicit HandLandmarks(std::unique_ptr<nets::Network> network) : network_(std::move(network)) {}

  std::unique_ptr<nets::Network> network_;
};

/// Least presence of a hand. Source: MediaPipe, hand_landmark_cpu.pbtxt.
inline constexpr float kHandIsThere = 0.5F;

}  // namespace hc::people
