// SPDX-License-Identifier: Apache-2.0
#pragma once
// Bytes on their way along a line that is slow, late or bad. Pure; the same seed, the same damage.

#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <string>
#include <string_view>

class Wire {
 public:
  static constexpr std::size_t kMostBytes = 65536;  ///< on their way; more are lost

  /// What is wrong with it.
  struct Faults {
    double delay = 0;             ///< of each byte [s]
    double bytes_per_second = 0;  ///< 0: unbounded
    double garbage = 0;           ///< share of bytes that are corrupted, 0 … 1
  };

  explicit Wire(std::uint64_t seed) : random_(seed) {}

  /// Puts bytes in. @param time  does not fall [s].
  void put(double time, std::string_view bytes, const Faults& faults);
  /// Those that have come out by then.
  std::string take(double time);
  /// When the next one comes out.
  [[nodiscard]] std::optional<double> next() const;
  /// Forgets all that is on its way, as if it were new.
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
  double free_at_ = 0;  // when the last one has been sent
};
