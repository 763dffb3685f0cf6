// SPDX-License-Identifier: Apache-2.0
#include <nets/depthwise.h>

#include <algorithm>

#include <nets/own_layer.h>

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nets/depthwise.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hc::nets::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// to[i] = bias + Σ weights[k] taps[k][i], within limits; up to four vectors more than `size`.
void add_taps(const float* const* taps, const float* weights, std::size_t count, float bias,
              float min, float max, std::size_t size, float* to) {
  const hn::ScalableTag<float> d;
  static_assert(hn::MaxLanes(d) <= 64 / sizeof(float));
  const std::size_t lanes = hn::Lanes(d);
  const auto low = hn::Set(d, min), high = hn::Set(d, max);
  for (std::size_t i = 0; i < size; i += 4 * lanes) {
    auto a = hn::Set(d, bias), b = a, c = a, e = a;
    for (std::size_t k = 0; k < count; ++k) {
      const float* tap = taps[k] + i;
      const auto weight = hn::Set(d, weights[k]);
      // Not fused, since not every processor can.
      a = hn::Add(a, hn::Mul(weight, hn::LoadU(d, tap)));
      b = hn::Add(b, hn::Mul(weight, hn::LoadU(d, tap + lanes)));
      c = hn::Add(c, hn::Mul(weight, hn::LoadU(d, tap + 2 * lanes)));
      e = hn::Add(e, hn::Mul(weight, hn::LoadU(d, tap + 3 * lanes)));
    }
    // In this order they keep what is not a number.
    hn::StoreU(hn::Min(high, hn::Max(low, a)), d, to + i);
    hn::StoreU(hn::Min(high, hn::Max(low, b)), d, to + i + lanes);
    hn::StoreU(hn::Min(high, hn::Max(low, c)), d, to + i + 2 * lanes);
    hn::StoreU(hn::Min(high, hn::Max(low, e)), d, to + i + 3 * lanes);
  }
}

}  // namespace hc::nets::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hc::nets {
namespace {

HWY_EXPORT(add_taps);

// Read and written beyond the end: four of the widest vectors.
constexpr std::size_t kBeyond = std::size_t{4} * 64 / sizeof(float);

std::size_t area(const cv::Size& size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

int divided_up(int a, int b) {
  return (a + b - 1) / b;
}

/// The layer in OpenCV's network.
class DepthwiseLayer final : public cv::dnn::Layer {
 public:
  explicit DepthwiseLayer(const cv::dnn::LayerParams& params) : Layer(params) {
    const auto whole = [&](const char* name) { return params.get<int>(name); };
    options_.window = {whole("kernel_h"), whole("kernel_w"), whole("pad_t"),
                       whole("pad_b"),    whole("pad_l"),    whole("pad_r")};
    options_.stride_down = whole("stride_h");
    options_.stride_right = whole("stride_w");
    options_.min = params.get<float>("min");
    options_.max = params.get<float>("max");
    to_ = {whole("width"), whole("height")};
  }

  bool getMemoryShapes(const std::vector<cv::dnn::MatShape>& inputs, int /*outputs*/,
                       std::vector<cv::dnn::MatShape>& outputs,
                       std::vector<cv::dnn::MatShape>& /*internals*/) const override {
    // OpenCV's shapes may differ from those of the file, as its pools compute them by floats.
    const auto& [window, down, right, min, max] = options_;
    CV_Assert(inputs[0].size() == 4 && inputs[0][0] == 1 && inputs[0][1] == blobs[0].size[0]);
    CV_Assert((inputs[0][2] + window.top + window.bottom - window.height) / down + 1 == to_.height);
    CV_Assert((inputs[0][3] + window.left + window.right - window.width) / right + 1 == to_.width);
    outputs = {{1, inputs[0][1], to_.height, to_.width}};
    return false;
  }

  void forward(cv::InputArrayOfArrays inputs, cv::OutputArrayOfArrays outputs,
               cv::OutputArrayOfArrays /*internals*/) override {
    std::vector<cv::Mat> from, to;
    inputs.getMatVector(from);
    outputs.getMatVector(to);
    const cv::Mat& image = from[0];
    cv::Mat& result = to[0];
    const cv::Mat &weights = blobs[0], &bias = blobs[1];
    const std::size_t window = weights.total() / static_cast<std::size_t>(weights.size[0]);
    cv::parallel_for_({0, image.size[1]}, [&](const cv::Range& channels) {
      PlaneConvolution plane(options_, {image.size[3], image.size[2]}, to_);
      for (int i = channels.start; i < channels.end; ++i)
        plane.convolve(image.ptr<float>(0, i), {weights.ptr<float>(i), window},
                       bias.ptr<float>()[i], result.ptr<float>(0, i));
    });
  }

 private:
  PlaneConvolution::Options options_;
  cv::Size to_;
};

}  // namespace

PlaneConvolution::PlaneConvolution(const Options& options, const cv::Size& from, const cv::Size& to)
    : options_(options), from_(from), to_(to) {
  const auto& [window, down, right, min, max] = options_;
  phase_ = {divided_up(from.width + window.left + window.right, right),
            divided_up(from.height + window.top + window.bottom, down)};
  phases_down_ = std::min(down, window.height);
  phases_right_ = std::min(right, window.width);
  const std::size_t count =
      static_cast<std::size_t>(phases_down_) * static_cast<std::size_t>(phases_right_);
  phases_.assign(count * area(phase_) + static_cast<std::size_t>(window.width) + kBeyond, 0);
  sums_.resize(area({phase_.width, to.height}) + kBeyond);
  for (int v = 0; v < window.height; ++v)
    for (int u = 0; u < window.width; ++u)
      taps_.push_back(phases_.data() + phase_at(v % down, u % right) + offset(v / down) +
                      u / right);
}

std::ptrdiff_t PlaneConvolution::phase_at(int row, int column) const {
  return (std::ptrdiff_t{row} * phases_right_ + column) * static_cast<std::ptrdiff_t>(area(phase_));
}

std::ptrdiff_t PlaneConvolution::offset(int row) const {
  return std::ptrdiff_t{row} * phase_.width;
}

void PlaneConvolution::fill_phases(const float* from) {
  const auto& [window, down, right, min, max] = options_;
  for (int y = 0; y < from_.height; ++y, from += from_.width) {
    const int row = y + window.top;
    if (row % down >= phases_down_) continue;
    float* phases = phases_.data() + phase_at(row % down, 0) + offset(row / down);
    if (right == 1) {
      std::copy_n(from, from_.width, phases + window.left);
      continue;
    }
    for (int first = 0; first < std::min(right, from_.width); ++first) {
      const int column = first + window.left;
      if (column % right >= phases_right_) continue;
      float* to = phases + phase_at(0, column % right) + column / right;
      for (int x = first; x < from_.width; x += right) *to++ = from[x];
    }
  }
}

void PlaneConvolution::convolve(const float* from, std::span<const float> weights, float bias,
                                float* to) {
  fill_phases(from);
  // All rows at once; sums in the padding columns are discarded.
  const std::size_t size = area({phase_.width, to_.height});
  HWY_DYNAMIC_DISPATCH(add_taps)
  (taps_.data(), weights.data(), taps_.size(), bias, options_.min, options_.max, size,
   sums_.data());
  for (int y = 0; y < to_.height; ++y)
    std::copy_n(sums_.data() + offset(y), to_.width, to + std::ptrdiff_t{y} * to_.width);
}

cv::dnn::LayerParams depthwise_params(const PlaneConvolution::Options& options,
                                      const cv::Size& to) {
  const auto& [window, down, right, min, max] = options;
  cv::dnn::LayerParams params;
  params.set("kernel_h", window.height);
  params.set("kernel_w", window.width);
  params.set("pad_t", window.top);
  params.set("pad_b", window.bottom);
  params.set("pad_l", window.left);
  params.set("pad_r", window.right);
  params.set("stride_h", down);
  params.set("stride_w", right);
  params.set("min", min);
  params.set("max", max);
  params.set("height", to.height);
  params.set("width", to.width);
  return params;
}

void register_depthwise() {
  register_layer<DepthwiseLayer>(kDepthwise);
}

}  // namespace hc::nets
#endif  // HWY_ONCE
