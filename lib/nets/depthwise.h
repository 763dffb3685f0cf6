// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depthwise convolutions: OpenCV's dnn computes those with windows of 5×5 without vectors, which
// took three quarters of the time of the networks of hands.

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <opencv2/dnn/dnn.hpp>

#include <nets/shapes.h>

namespace hc::nets {

/// The depthwise convolution of one channel after another. The results are the same, bit by bit,
/// on every processor. Pure.
class PlaneConvolution {
 public:
  struct Options {
    Window window;
    int stride_down = 1, stride_right = 1;
    float least = -std::numeric_limits<float>::infinity();  ///< of the results, as by ReLU6
    float most = std::numeric_limits<float>::infinity();
  };

  PlaneConvolution(const Options& options, const cv::Size& from, const cv::Size& to);

  /// @param from  a channel of the image, row by row.
  /// @param weights  of its window, row by row.
  /// @param[out] to  the channel of the result, row by row.
  void convolve(const float* from, std::span<const float> weights, float bias, float* to);

 private:
  void fill_phases(const float* from);

  Options options_;
  cv::Size from_, to_;
  // The image with its padding, apart by the remainders of row and column to the strides, so that
  // neighbours in a phase are neighbours in the result.
  cv::Size phase_;
  std::vector<float> phases_, sums_;
  std::vector<const float*> taps_;  // where in the phases each place of the window begins
};

/// The type of OpenCV's layer that has such weights (channels, 1, height, width) and bias as its
/// blobs; depthwise_params() makes its parameters.
inline constexpr const char* kDepthwise = "HypercolumnDepthwise";
cv::dnn::LayerParams depthwise_params(const PlaneConvolution::Options& options, const cv::Size& to);
/// Makes OpenCV know the type. May be called again.
void register_depthwise();

}  // namespace hc::nets
