// SPDX-License-Identifier: Apache-2.0
#pragma once
// Bytes in transit on a slow, delayed or corrupting line. Pure; corruption depends on the seed.

#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <string>
#include <string_view>

class Wire {
 public:
  static constexpr std::size_t kMostBytes = 65536;  ///< in transit; more are lost

  struct Faults {
    double delay = 0;             ///< of each byte [s]
    double bytes_per_second = 0;  ///< 0: unbounded
    double garbage = 0;           ///< share of bytes that are corrupted, 0 … 1
  };

  explicit Wire(std::uint64_t seed) : random_(seed) {}

  /// Puts bytes in. @param time  must not decrease [s].
  void put(double time, std::string_view bytes, const Faults& faults);
  /// The bytes that have arrived by then.
  std::string take(double time);
  /// When the next byte arrives.
  [[nodiscard]] std::optional<double> next() const;
  /// Discards the bytes in transit.
  void clear() {
    bytes_.clear();
    free_at_ = 0;
  }

 private:
  struct Byte {
    double due;
    char value;
  };
  std::mt19937_64 random_;
  std::deque<Byte> bytes_;
  double free_at_ = 0;  // when the last byte has been sent
};
