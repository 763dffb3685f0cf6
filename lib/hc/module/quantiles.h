// SPDX-License-Identifier: Apache-2.0
#pragma once
// Quantiles of durations in little memory. Pure. Internal.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace hc::internal {

/// A histogram of durations, whose classes are 12.5 % wide: the accuracy of the quantiles. 2 KiB.
/// Cost of a duration: a few instructions.
class Quantiles {
 public:
  /// @param duration  [ns]; below 0 counts as 0.
  void add(std::int64_t duration) {
    auto value = duration < 0 ? 0 : static_cast<std::uint64_t>(duration);
    ++counts_[class_of(value)];
    ++total_;
    if (value > max_) max_ = value;
  }

  [[nodiscard]] bool empty() const { return total_ == 0; }
  [[nodiscard]] std::int64_t max() const { return static_cast<std::int64_t>(max_); }

  /// The smallest duration that a `part` of all, 0 … 1, do not exceed, up to the width of its
  /// class; 0 if there are none. [ns]
  [[nodiscard]] std::int64_t quantile(double part) const {
    auto rank = static_cast<std::uint64_t>(part * static_cast<double>(total_));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      seen += counts_[i];
      if (seen > rank || (seen > 0 && seen == total_))
        return static_cast<std::int64_t>(std::min(top_of(i), max_));
    }
    return 0;
  }

  void clear() { *this = {}; }

 private:
  static constexpr std::size_t kSteps = 8;  // per octave
  static constexpr std::size_t kClasses = 64 * kSteps;

  /// Values below 8 have a class each; from there on an octave has 8.
  static std::size_t class_of(std::uint64_t value) {
    if (value < kSteps) return value;
    auto octave = static_cast<unsigned>(std::bit_width(value)) - 4;
    return (octave + 1) * kSteps + ((value >> octave) & (kSteps - 1));
  }
  /// The largest value of a class.
  static std::uint64_t top_of(std::size_t index) {
    if (index < kSteps) return index;
    auto octave = static_cast<unsigned>(index / kSteps) - 1;
    return ((std::uint64_t{kSteps} + index % kSteps + 1) << octave) - 1;
  }

  std::array<std::uint32_t, kClasses> counts_{};
  std::uint64_t total_ = 0, max_ = 0;
};

}  // namespace hc::internal
