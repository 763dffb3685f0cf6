// SPDX-License-Identifier: Apache-2.0
#pragma once
// Convolutions with a window of one pixel: OpenCV's dnn spent half of the time of the network that
// finds faces on them, and a fifth on the sums and activations after them.

#include <cstddef>
#include <limits>
#include <vector>

#include <opencv2/dnn/dnn.hpp>

namespace hc::nets {

/// A convolution with a window of one pixel: a product of matrices. The results are the same, bit
/// by bit, on every processor, of finite numbers. Pure.
class PointwiseConvolution {
 public:
  /// Applied to each sum: negative ones are multiplied by the slope of their channel (0 is ReLU, 1
  /// changes nothing), others limited to the maximum.
  struct Activation {
    std::vector<float> slopes;
    float max = std::numeric_limits<float>::infinity();
  };
  /// Images, one channel after the other.
  struct Planes {
    const float* from;
    const float* addend;  ///< added to the result before its activation, or null
    float* to;
    std::size_t size;  ///< of each channel [px]
  };
  /// Where a part of the pixels had best begin.
  static constexpr std::size_t kStep = 64;

  /// @param weights  (out, in)
  /// @param bias  of each channel of the result
  PointwiseConvolution(const cv::Mat& weights, std::vector<float> bias, Activation activation);

  /// Computes the pixels from `begin` to before `end`.
  void convolve(const Planes& planes, std::size_t begin, std::size_t end) const;

  /// By channels of the result, filled up to a multiple of four.
  struct Packed {
    std::size_t in, out;
    std::vector<float> weights;  ///< (out / 4, in, 4)
    std::vector<float> bias, slopes;
    float max;
  };

 private:
  Packed packed_;
};

/// The type of OpenCV's layer. Its blobs are weights (out, in), bias and slopes; its inputs the
/// image and, if there are two, what is added.
inline constexpr const char* kPointwise = "HypercolumnPointwise";
cv::dnn::LayerParams pointwise_params(const cv::Mat& weights, const cv::Mat& bias,
                                      const PointwiseConvolution::Activation& activation);
/// Registers the type with OpenCV. May be called again.
void register_pointwise();

}  // namespace hc::nets
