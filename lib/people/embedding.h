// SPDX-License-Identifier: Apache-2.0
#pragma once
// Describes faces by numbers that are near each other for one person (dlib's network).

#include <array>
#include <memory>
#include <optional>

#include <opencv2/core/mat.hpp>

#include <hc/base/result.h>
#include <nets/network.h>
#include <people/face.h>

namespace hc::people {

/// What identifies a person's face: this is biometric data.
using Embedding = std::array<float, 128>;

/// Whether numbers can be those of a face: none is NaN, or far from those of dlib's network.
bool is_embedding(const Embedding& numbers);

/// Euclidean distance. Measured: doc/figures.md#people.
float distance(const Embedding& a, const Embedding& b);

/// Describes faces.
class Identifier {
 public:
  /// Errors: Malformed (not such a network).
  static Result<Identifier> make(std::unique_ptr<nets::Network> network);

  /// The embedding of a face in an image (height, width) of u8, RGB or grey; nothing where the
  /// network's numbers are none.
  std::optional<Embedding> describe(const cv::Mat& image, const Face& face);

 private:
  explicit Identifier(std::unique_ptr<nets::Network> network) : network_(std::move(network)) {}

  std::unique_ptr<nets::Network> network_;
};

/// A square image of a face, upright and in the middle, as the network was trained with.
/// @returns  (150, 150) of u8, RGB; black outside of the image.
cv::Mat face_chip(const cv::Mat& image, const Face& face);

}  // namespace hc::people
