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
///     auto finder = HC_TRY(FaceFinder::read_wide());
///     for (const Face& face : finder.find(image, {0, 0, 800, 600})) …
class FaceFinder {
 public:
  /// The small network, for faces that fill a good part of an image of 128 × 128
  /// (face_detection_short_range), and the large one, for those in all of an image of 4 : 3, as
  /// most cameras' are (face_detection_full_range, for 256 × 192 instead of 192 × 192).
  ///
  /// Errors: those of nets::Network::read() and make().
  static Result<FaceFinder> read_near();
  static Result<FaceFinder> read_wide();
  /// @param network  face_detection_short_range, whose images are of 128 × 128, or
  ///     face_detection_full_range for another size.
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
