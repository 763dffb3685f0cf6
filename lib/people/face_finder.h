// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds faces in images, by a small neural network (BlazeFace, MediaPipe's face detection).

#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <hc/base/result.h>
#include <nets/network.h>
#include <people/face.h>
#include <people/ssd.h>

namespace hc::people {

/// Finds faces.
///
///     auto finder = FaceFinder::make(std::move(network));
///     for (const Face& face : finder->find(image, {0, 0, 800, 600})) …
class FaceFinder {
 public:
  /// @param network  face_detection_short_range, or face_detection_full_range for images of any
  ///     size that is one of multiples of 32.
  ///
  /// Errors: Malformed (its inputs and outputs are not those of such a network).
  static Result<FaceFinder> make(std::unique_ptr<nets::Network> network);

  /// The faces in a part of an image, which may extend beyond it, best first.
  /// @param image  (height, width) of u8, RGB or grey.
  /// @param least  of their scores.
  std::vector<Face> find(const cv::Mat& image, const cv::Rect& part, float least = 0.5F);
  /// (width, height) of the images that the network sees. [px]
  [[nodiscard]] cv::Size size() const { return ssd_.size(); }

 private:
  explicit FaceFinder(Ssd ssd) : ssd_(std::move(ssd)) {}

  Ssd ssd_;
};

}  // namespace hc::people
