// SPDX-License-Identifier: Apache-2.0
#include <nets/pointwise.h>

#include <algorithm>
#include <utility>

#include <nets/own_layer.h>

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
          float* block) {
  const std::size_t lanes = hn::Lanes(D());
  for (std::size_t k = 0; k < channels; ++k, from += size, block += 2 * lanes) {
    if (count == 2 * lanes) {
      hn::StoreU(hn::LoadU(D(), from), D(), block);
      hn::StoreU(hn::LoadU(D(), from + lanes), D(), block + lanes);
    } else {
      std::fill(std::copy_n(from, count, block), block + 2 * lanes, 0.0F);
    }
  }
}

/// Stores the activation of a sum, to which a vector is added unless it is null.
HWY_INLINE void store(V sum, const float* addend, float slope, float max, float* to) {
  const D d;
  if (addend) sum = hn::Add(sum, hn::LoadU(d, addend));
  // Min() in this order keeps what is not a number.
  hn::StoreU(hn::IfThenElse(hn::Lt(sum, hn::Zero(d)), hn::Mul(sum, hn::Set(d, slope)),
                            hn::Min(hn::Set(d, max), sum)),
             d, to);
}

/// Four channels of the result from `first` on, for the two vectors of pixels in a block.
/// @param addend  or null. Like the results, its channels are `step` apart.
void multiply(const PointwiseConvolution::Packed& by, std::size_t first, const float* block,
              const float* addend, float* to, std::size_t step) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const float *weights = by.weights.data() + first * by.in, *bias = by.bias.data() + first;
  V a = hn::Set(d, bias[0]), b = hn::Set(d, bias[1]), c = hn::Set(d, bias[2]),
    e = hn::Set(d, bias[3]);
  V a2 = a, b2 = b, c2 = c, e2 = e;
  for (std::size_t k = 0; k < by.in; ++k, block += 2 * lanes, weights += 4) {
    const V x = hn::LoadU(d, block), x2 = hn::LoadU(d, block + lanes);
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
  const float* slopes = by.slopes.data() + first;
  const auto at = [&](std::size_t channel) { return addend ? addend + channel * step : nullptr; };
  const auto after = [&](const float* vector) { return vector ? vector + lanes : nullptr; };
  store(a, at(0), slopes[0], by.max, to);
  store(a2, after(at(0)), slopes[0], by.max, to + lanes);
  store(b, at(1), slopes[1], by.max, to + step);
  store(b2, after(at(1)), slopes[1], by.max, to + step + lanes);
  store(c, at(2), slopes[2], by.max, to + 2 * step);
  store(c2, after(at(2)), slopes[2], by.max, to + 2 * step + lanes);
  store(e, at(3), slopes[3], by.max, to + 3 * step);
  store(e2, after(at(3)), slopes[3], by.max, to + 3 * step + lanes);
}

/// The pixels from `begin` to before `end`. @see PointwiseConvolution
void convolve(const PointwiseConvolution::Packed& by, const PointwiseConvolution::Planes& planes,
              std::size_t begin, std::size_t end) {
  static_assert(PointwiseConvolution::kStep % (2 * hn::MaxLanes(D())) == 0);
  const std::size_t width = 2 * hn::Lanes(D());
  std::vector<float> block(width * by.in), addend(4 * width), result(4 * width);
  for (std::size_t at = begin; at < end; at += width) {
    const std::size_t count = std::min(width, end - at);
    pack(planes.from + at, planes.size, by.in, count, block.data());
    for (std::size_t first = 0; first < by.out; first += 4) {
      const std::size_t channels = std::min<std::size_t>(4, by.out - first);
      const std::size_t place = first * planes.size + at;
      if (count == width && channels == 4) {
        multiply(by, first, block.data(), planes.addend ? planes.addend + place : nullptr,
                 planes.to + place, planes.size);
        continue;
      }
      // What is not whole is computed in memory of its own.
      for (std::size_t k = 0; k < channels && planes.addend; ++k)
        std::copy_n(planes.addend + place + k * planes.size, count, addend.data() + k * width);
      multiply(by, first, block.data(), planes.addend ? addend.data() : nullptr, result.data(),
               width);
      for (std::size_t k = 0; k < channels; ++k)
        std::copy_n(result.data() + k * width, count, planes.to + place + k * planes.size);
    }
  }
}

}  // namespace hc::nets::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hc::nets {
namespace {

HWY_EXPORT(convolve);

/// The layer in OpenCV's network.
class PointwiseLayer final : public cv::dnn::Layer {
 public:
  explicit PointwiseLayer(const cv::dnn::LayerParams& params)
      : Layer(params),
        convolution_(blobs[0], {blobs[1].begin<float>(), blobs[1].end<float>()},
                     {{blobs[2].begin<float>(), blobs[2].end<float>()}, params.get<float>("max")}) {
  }

  bool getMemoryShapes(const std::vector<cv::dnn::MatShape>& inputs, int /*outputs*/,
                       std::vector<cv::dnn::MatShape>& outputs,
                       std::vector<cv::dnn::MatShape>& /*internals*/) const override {
    // OpenCV's shapes may differ from those of the file, as its pools compute them by floats.
    CV_Assert(inputs[0].size() == 4 && inputs[0][0] == 1 && inputs[0][1] == blobs[0].cols);
    outputs = {{1, blobs[0].rows, inputs[0][2], inputs[0][3]}};
    CV_Assert(inputs.size() == 1 || inputs[1] == outputs[0]);
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
    constexpr auto kStep = PointwiseConvolution::kStep;
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
    : packed_{static_cast<std::size_t>(weights.cols),
              static_cast<std::size_t>(weights.rows),
              {},
              std::move(bias),
              std::move(activation.slopes),
              activation.max} {
  auto& [in, out, packed, biases, slopes, max] = packed_;
  const std::size_t rows = (out + 3) / 4 * 4;
  packed.resize(rows * in);
  biases.resize(rows);
  slopes.resize(rows);
  for (std::size_t row = 0; row < out; ++row)
    for (std::size_t k = 0; k < in; ++k)
      packed[(row / 4 * in + k) * 4 + row % 4] =
          weights.at<float>(static_cast<int>(row), static_cast<int>(k));
}

void PointwiseConvolution::convolve(const Planes& planes, std::size_t begin,
                                    std::size_t end) const {
  HWY_DYNAMIC_DISPATCH(convolve)(packed_, planes, begin, end);
}

cv::dnn::LayerParams pointwise_params(const cv::Mat& weights, const cv::Mat& bias,
                                      const PointwiseConvolution::Activation& activation) {
  cv::dnn::LayerParams params;
  params.blobs = {weights, bias, cv::Mat(activation.slopes, true).reshape(1, 1)};
  params.set("max", activation.max);
  return params;
}

void register_pointwise() {
  register_layer<PointwiseLayer>(kPointwise);
}

}  // namespace hc::nets
#endif  // HWY_ONCE
