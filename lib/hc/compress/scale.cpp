// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/scale.h>

#include <algorithm>
#include <limits>
#include <vector>

#include <hc/base/check.h>
#include <hc/compress/compress.h>

namespace hc {
namespace {

/// The source pixels of a row, or source rows, that one pixel or row of the result covers.
struct Cover {
  std::size_t first = 0;       ///< followed by the others
  std::vector<float> weights;  ///< sum to 1
};

std::vector<Cover> covers(std::size_t from, std::size_t to) {
  std::vector<Cover> all(to);
  const double size = static_cast<double>(from) / static_cast<double>(to);
  for (std::size_t i = 0; i < to; ++i) {
    const double begin = static_cast<double>(i) * size, end = begin + size;
    auto& cover = all[i];
    cover.first = std::min(from - 1, static_cast<std::size_t>(begin));
    for (auto at = static_cast<double>(cover.first); at < end && at < static_cast<double>(from);
         ++at)
      if (const double part = std::min(at + 1, end) - std::max(at, begin);
          part > 0 || cover.weights.empty())
        cover.weights.push_back(static_cast<float>(part / size));
  }
  return all;
}

template <typename T>
class Shrinking {
 public:
  Shrinking(MatrixView<const T> from, MatrixView<T> to)
      : from_(from),
        to_(to),
        columns_(covers(from.width(), to.width())),
        rows_(covers(from.height(), to.height())),
        narrow_(to.width() * to.components()),
        sum_(narrow_.size()) {}

  void run() {
    for (std::size_t y = 0; y < to_.height(); ++y) {
      std::fill(sum_.begin(), sum_.end(), 0.0F);
      for (std::size_t i = 0; i < rows_[y].weights.size(); ++i)
        add(rows_[y].first + i, rows_[y].weights[i]);
      // Weights are rounded; clamp, so that white stays white.
      static constexpr auto kWhite = static_cast<float>(std::numeric_limits<T>::max());
      std::transform(sum_.begin(), sum_.end(), to_.row(y).begin(),
                     [](float value) { return static_cast<T>(std::min(value + 0.5F, kWhite)); });
    }
  }

 private:
  void add(std::size_t y, float weight) {
    // Two rows of the result may cover the same source row: shrink it once.
    if (y != narrowed_) narrow(from_.row(y));
    narrowed_ = y;
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += weight * narrow_[i];
  }

  void narrow(std::span<const T> row) {
    const std::size_t components = from_.components();
    float* out = narrow_.data();
    for (const auto& cover : columns_)
      for (std::size_t k = 0; k < components; ++k) {
        const T* in = row.data() + cover.first * components + k;
        float sum = 0;
        for (const float weight : cover.weights) {
          sum += weight * static_cast<float>(*in);
          in += components;
        }
        *out++ = sum;
      }
  }

  MatrixView<const T> from_;
  MatrixView<T> to_;
  std::vector<Cover> columns_, rows_;
  std::vector<float> narrow_, sum_;                      // rows as wide as to_
  std::size_t narrowed_ = static_cast<std::size_t>(-1);  // the row of from_ in narrow_
};

template <typename T>
Message shrink_plain(const Message& image, const Header& header) {
  Draft draft = Draft::make(header);
  Shrinking<T>(*image.view<T>(), draft.view<T>()).run();
  return std::move(draft).finish();
}

}  // namespace

Result<Message> shrink(const Message& image, std::int32_t width, std::int32_t height) {
  auto plain = HC_TRY(expand(image));
  Header header = plain.header;
  HC_CHECK(width > 0 && width <= header.width && height > 0 && height <= header.height, width,
           height, header.width, header.height);
  header.width = width;
  header.height = height;
  if (header.info.scalar == Scalar::U8) return shrink_plain<std::uint8_t>(plain, header);
  HC_CHECK(header.info.scalar == Scalar::U16, matrix_text(header.info));
  return shrink_plain<std::uint16_t>(plain, header);
}

}  // namespace hc
