// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/smoother.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/stereo/smoother.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hc::vision::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void mean_along(const std::uint16_t* from, std::ptrdiff_t step, int count, std::uint16_t* to) {
  const hn::ScalableTag<std::int16_t> d;
  const hn::Repartition<std::uint8_t, decltype(d)> d8;
  // 2¹⁵ / n by its bytes, for n = 0 … 15. With n = 1 the sum of the differences is 0.
  alignas(16) std::uint8_t low[16] = {}, high[16] = {};
  for (int n = 2; n <= 2 * Smoother::kReach + 1; ++n) {
    const int inverse = ((1 << 15) + n / 2) / n;
    low[n] = static_cast<std::uint8_t>(inverse & 0xFF);
    high[n] = static_cast<std::uint8_t>(inverse >> 8);
  }
  const auto low_bytes = hn::LoadDup128(d8, low), high_bytes = hn::LoadDup128(d8, high);
  const auto low_half = hn::Set(d, std::int16_t{0xFF});
  const auto too_far = hn::Set(d, std::int16_t{Smoother::kRange + 1});
  const auto zero = hn::Zero(d);
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t x = 0; x < count; x += lanes) {
    const auto at = [&](std::ptrdiff_t away) {
      return hn::LoadU(d, reinterpret_cast<const std::int16_t*>(from + x + away * step));
    };
    const auto own = at(0);
    auto sum = zero, number = zero;
    for (std::ptrdiff_t k = -Smoother::kReach; k <= Smoother::kReach; ++k) {
      const auto other = at(k);
      const auto difference = hn::Sub(other, own);
      const auto is_alike = hn::And(hn::Lt(hn::Abs(difference), too_far), hn::Gt(other, zero));
      sum = hn::Add(sum, hn::IfThenElseZero(is_alike, difference));
      number = hn::Sub(number, hn::VecFromMask(d, is_alike));
    }
    const auto index = hn::BitCast(d8, hn::Or(number, hn::ShiftLeft<8>(number)));
    const auto inverse =
        hn::Or(hn::And(hn::BitCast(d, hn::TableLookupBytes(low_bytes, index)), low_half),
               hn::AndNot(low_half, hn::BitCast(d, hn::TableLookupBytes(high_bytes, index))));
    const auto mean = hn::Add(own, hn::MulFixedPoint15(sum, inverse));
    const auto result =
        hn::IfThenElseZero(hn::Gt(own, zero), hn::Max(mean, hn::Set(d, std::int16_t{1})));
    hn::StoreU(result, d, reinterpret_cast<std::int16_t*>(to + x));
  }
}

}  // namespace hc::vision::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hc::vision {

HWY_EXPORT(mean_along);

void mean_along(const std::uint16_t* from, std::ptrdiff_t step, int count, std::uint16_t* to) {
  HWY_DYNAMIC_DISPATCH(mean_along)(from, step, count, to);
}

void Smoother::smooth(const cv::Mat& disparity, cv::Mat& smooth) {
  constexpr int kLanes = 32;  // at most; they are read and written beyond the last column
  const cv::Size padded(disparity.cols + 2 * kReach + kLanes, disparity.rows + 2 * kReach);
  for (cv::Mat* image : {&rows_, &columns_})
    if (image->size() != padded) *image = cv::Mat::zeros(padded, CV_16U);
  smooth.create(disparity.size(), CV_16U);
  cv::parallel_for_({0, disparity.rows}, [&](const cv::Range& range) {
    for (int y = range.start; y < range.end; ++y) {
      auto* row = rows_.ptr<std::uint16_t>(y) + kReach;
      std::copy_n(disparity.ptr<std::uint16_t>(y), disparity.cols, row);
      mean_along(row, 1, disparity.cols, columns_.ptr<std::uint16_t>(y + kReach));
    }
  });
  cv::parallel_for_({0, disparity.rows}, [&](const cv::Range& range) {
    std::vector<std::uint16_t> row(columns_.step1());
    for (int y = range.start; y < range.end; ++y) {
      mean_along(columns_.ptr<std::uint16_t>(y + kReach),
                 static_cast<std::ptrdiff_t>(columns_.step1()), disparity.cols, row.data());
      std::copy_n(row.data(), disparity.cols, smooth.ptr<std::uint16_t>(y));
    }
  });
}

}  // namespace hc::vision
#endif  // HWY_ONCE
