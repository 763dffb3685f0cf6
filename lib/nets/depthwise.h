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
/// on every processor, of finite numbers. Pure.
class PlaneConvolution {
 public:
  struct Options {
    Window window;
    int stride_down = 1, stride_right = 1;
    float min = -std::numeric_limits<float>::infinity();  ///< of the results, as by ReLU6
    float max = std::numeric_limits<float>::infinity();
  };

  PlaneConvolution(const Options& options, const cv::Size& from, const cv::Size& to);
  PlaneConvolution(const PlaneConvolution&) = delete;  // taps_ points into phases_
  PlaneConvolution& operator=(const PlaneConvolution&) = delete;

  /// @param from  a channel of the image, row by row.
  /// @param weights  of its window, row by row.
  /// @param[out] to  the channel of the result, row by row.
  void convolve(const float* from, std::span<const float> weights, float bias, float* to);

 private:
  void fill_phases(const float* from);
  /// Where the phase of a row and column begins, and a row in it.
  [[nodiscard]] std::ptrdiff_t phase_at(int row, int column) const;
  [[nodiscard]] std::ptrdiff_t offset(int row) const;

  Options options_;
  cv::Size from_, to_;
  // The image with its padding, split into its polyphase components: rows and columns modulo the
  // strides, as far as the window has them. Neighbours in a phase are neighbours in the result.
  int phases_down_ = 1, phases_right_ = 1;
  cv::Size phase_;
  std::vector<float> phases_, sums_;
  std::vector<const float*> taps_;  // the first input of each place of the window
};

/// The type of OpenCV's layer whose blobs are weights (channels, 1, height, width) and bias;
/// depthwise_params() makes its parameters.
inline constexpr const char* kDepthwise = "HypercolumnDepthwise";
cv::dnn::LayerParams depthwise_params(const PlaneConvolution::Options& options, const cv::Size& to);
/// Registers the type with OpenCV. May be called again.
void register_depthwise();

}  // namespace hc::nets
