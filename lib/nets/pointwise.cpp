// SPDX-License-Identifier: Apache-2.0
#include <nets/pointwise.h>

#include <algorithm>
#include <mutex>
#include <utility>

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nets/pointwise.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hc::nets::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

/// Copies `count` pixels of each channel beside each other, and zeros after them.
void pack(const float* from, std::size_t size, std::size_t channels, std::size_t count,
          float* panel) {
  const std::size_t lanes = hn::Lanes(D());
  for (std::size_t k = 0; k < channels; ++k, from += size, panel += 2 * lanes) {
    if (count == 2 * lanes) {
      hn::StoreU(hn::LoadU(D(), from), D(), panel);
      hn::StoreU(hn::LoadU(D(), from + lanes), D(), panel + lanes);
    } else {
      std::fill(std::copy_n(from, count, panel), panel + 2 * lanes, 0.0F);
    }
  }
}

/// Where the two vectors of pixels of a channel go, what is added to them, or null, and then how
/// they are activated.
struct Row {
  const float* plus;
  float* to;
  float slope, max;
};

HWY_INLINE V activated(V sum, const Row& row, std::size_t at) {
  if (row.plus) sum = hn::Add(sum, hn::LoadU(D(), row.plus + at));
  return hn::IfThenElse(hn::Lt(sum, hn::Zero(D())), hn::Mul(sum, hn::Set(D(), row.slope)),
                        hn::Min(sum, hn::Set(D(), row.max)));
}
HWY_INLINE void finish(V first, V second, const Row& row) {
  hn::StoreU(activated(first, row, 0), D(), row.to);
  hn::StoreU(activated(second, row, hn::Lanes(D())), D(), row.to + hn::Lanes(D()));
}

/// Four channels of the result, for the pixels of a panel.
void multiply(const float* weights, const float* bias, std::size_t channels, const float* panel,
              const Row* rows) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  V a = hn::Set(d, bias[0]), b = hn::Set(d, bias[1]), c = hn::Set(d, bias[2]),
    e = hn::Set(d, bias[3]);
  V a2 = a, b2 = b, c2 = c, e2 = e;
  for (std::size_t k = 0; k < channels; ++k, panel += 2 * lanes, weights += 4) {
    const V x = hn::LoadU(d, panel), x2 = hn::LoadU(d, panel + lanes);
    const V u = hn::Set(d, weights[0]), v = hn::Set(d, weights[1]), w = hn::Set(d, weights[2]),
            z = hn::Set(d, weights[3]);
    // Not fused, since not every processor can.
    a = hn::Add(a, hn::Mul(u, x));
    a2 = hn::Add(a2, hn::Mul(u, x2));
    b = hn::Add(b, hn::Mul(v, x));
    b2 = hn::Add(b2, hn::Mul(v, x2));
    c = hn::Add(c, hn::Mul(w, x));
    c2 = hn::Add(c2, hn::Mul(w, x2));
    e = hn::Add(e, hn::Mul(z, x));
    e2 = hn::Add(e2, hn::Mul(z, x2));
  }
  finish(a, a2, rows[0]);
  finish(b, b2, rows[1]);
  finish(c, c2, rows[2]);
  finish(e, e2, rows[3]);
}

/// Of the pixels from `begin` to before `end`. @see PointwiseConvolution
void convolve(const float* weights, const float* bias, const float* slopes, float max,
              std::size_t in, std::size_t out, const PointwiseConvolution::Planes& planes,
              std::size_t begin, std::size_t end) {
  const std::size_t width = 2 * hn::Lanes(D());
  std::vector<float> panel(width * in), plus(4 * width), results(4 * width);
  for (std::size_t at = begin; at < end; at += width) {
    const std::size_t count = std::min(width, end - at);
    pack(planes.from + at, planes.size, in, count, panel.data());
    for (std::size_t first = 0; first < out; first += 4) {
      const std::size_t channels = std::min<std::size_t>(4, out - first);
      // What is not whole goes by way of memory of its own.
      const bool is_whole = count == width && channels == 4;
      Row rows[4];
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t place = (first + k) * planes.size + at;
        rows[k] = {planes.plus ? plus.data() + k * width : nullptr, results.data() + k * width,
                   k < channels ? slopes[first + k] : 0, max};
        if (is_whole)
          rows[k] = {planes.plus ? planes.plus + place : nullptr, planes.to + place,
                     slopes[first + k], max};
        else if (planes.plus && k < channels)
          std::copy_n(planes.plus + place, count, plus.data() + k * width);
      }
      multiply(weights + first * in, bias + first, in, panel.data(), rows);
      for (std::size_t k = 0; k < channels && !is_whole; ++k)
        std::copy_n(results.data() + k * width, count,
                    planes.to + (first + k) * planes.size + at);
    }
  }
}

}  // namespace hc::nets::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hc::nets {
namespace {

HWY_EXPORT(convolve);

/// Pixels that a thread takes at once: so many that its panels are whole.
constexpr std::size_t kStep = 64;

/// The layer in OpenCV's network.
class PointwiseLayer final : public cv::dnn::Layer {
 public:
  explicit PointwiseLayer(const cv::dnn::LayerParams& params)
      : Layer(params),
        convolution_(blobs[0], {blobs[1].begin<float>(), blobs[1].end<float>()},
                     {{blobs[2].begin<float>(), blobs[2].end<float>()}, params.get<float>("max")}) {
  }
  static cv::Ptr<Layer> create(cv::dnn::LayerParams& params) {
    return cv::makePtr<PointwiseLayer>(params);
  }

  bool getMemoryShapes(const std::vector<cv::dnn::MatShape>& inputs, int /*outputs*/,
                       std::vector<cv::dnn::MatShape>& outputs,
                       std::vector<cv::dnn::MatShape>& /*internals*/) const override {
    outputs = {{inputs[0][0], blobs[0].rows, inputs[0][2], inputs[0][3]}};
    return false;
  }

  void forward(cv::InputArrayOfArrays inputs, cv::OutputArrayOfArrays outputs,
               cv::OutputArrayOfArrays /*internals*/) override {
    std::vector<cv::Mat> from, to;
    inputs.getMatVector(from);
    outputs.getMatVector(to);
    const auto size =
        static_cast<std::size_t>(from[0].size[2]) * static_cast<std::size_t>(from[0].size[3]);
    const PointwiseConvolution::Planes planes{from[0].ptr<float>(),
                                              from.size() > 1 ? from[1].ptr<float>() : nullptr,
                                              to[0].ptr<float>(), size};
    const auto steps = static_cast<int>((size + kStep - 1) / kStep);
    cv::parallel_for_({0, steps}, [&](const cv::Range& range) {
      convolution_.convolve(planes, static_cast<std::size_t>(range.start) * kStep,
                            std::min(size, static_cast<std::size_t>(range.end) * kStep));
    });
  }

 private:
  PointwiseConvolution convolution_;
};

}  // namespace

PointwiseConvolution::PointwiseConvolution(const cv::Mat& weights, std::vector<float> bias,
                                           Activation activation)
    : in_(static_cast<std::size_t>(weights.cols)),
      out_(static_cast<std::size_t>(weights.rows)),
      weights_((out_ + 3) / 4 * 4 * in_),
      bias_(std::move(bias)),
      activation_(std::move(activation)) {
  bias_.resize((out_ + 3) / 4 * 4);
  for (std::size_t row = 0; row < out_; ++row)
    for (std::size_t k = 0; k < in_; ++k)
      weights_[(row / 4 * in_ + k) * 4 + row % 4] =
          weights.at<float>(static_cast<int>(row), static_cast<int>(k));
}

void PointwiseConvolution::convolve(const Planes& planes, std::size_t begin,
                                    std::size_t end) const {
  HWY_DYNAMIC_DISPATCH(convolve)
  (weights_.data(), bias_.data(), activation_.slopes.data(), activation_.max, in_, out_, planes,
   begin, end);
}

cv::dnn::LayerParams pointwise_params(const cv::Mat& weights, const cv::Mat& bias,
                                      const PointwiseConvolution::Activation& activation) {
  cv::dnn::LayerParams params;
  params.blobs = {weights, bias, cv::Mat(activation.slopes, true).reshape(1, 1)};
  params.set("max", activation.max);
  return params;
}

void register_pointwise() {
  static std::once_flag once;
  std::call_once(once,
                 [] { cv::dnn::LayerFactory::registerLayer(kPointwise, PointwiseLayer::create); });
}

}  // namespace hc::nets
#endif  // HWY_ONCE
