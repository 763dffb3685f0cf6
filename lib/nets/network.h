// SPDX-License-Identifier: Apache-2.0
#pragma once
// Computes the layers of a network, by OpenCV's dnn and our own pointwise and depthwise
// convolutions.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <hc/base/result.h>
#include <nets/layers.h>

namespace hc::nets {

/// Maximum number of multiplications of a network.
inline constexpr long long kMostMultiplications = 20'000'000'000;

/// A network of one image, ready to be computed.
///
///     const auto network = HC_TRY(Network::read(weights_path("hand_landmark_lite.tflite")));
///     const auto outputs = network->run(image);
///
/// Different ones may be used from different threads.
class Network {
 public:
  virtual ~Network() = default;

  /// @param path  of a file of TensorFlow Lite, or of face-api's face recognition: a manifest
  ///     NAME.json, with NAME.bin beside it.
  /// @param size  (height, width) of its images, if not that in the file. @see resized()
  ///
  /// Errors: those of read_weights(), read_tflite(), read_face_recognition(), resized() and make(),
  /// beginning with the path.
  static Result<std::unique_ptr<Network>> read(
      const std::string& path, std::optional<std::array<int, 2>> size = std::nullopt);
  /// Layers may be those of any file, since all shapes are checked first.
  ///
  /// Errors: Malformed (a shape does not follow from those before it), Unsupported (a layer cannot
  /// be computed with these), TooLarge (more than kMostMultiplications, or kMostNumbers;
  /// not enough memory).
  /// Cost: computes it once.
  static Result<std::unique_ptr<Network>> make(const Layers& layers);

  /// (height, width, channels)
  [[nodiscard]] virtual const Shape& input() const = 0;
  /// @param image  (height, width, channels) f32, as input() is, in the range that the network has
  ///     been trained with.
  /// @returns  the outputs in the file's order, f32: a matrix whose columns are their last extent.
  virtual std::vector<cv::Mat> run(const cv::Mat& image) = 0;
};

}  // namespace hc::nets
