// SPDX-License-Identifier: Apache-2.0
#pragma once
// Random numbers that are the same on every machine. Pure.

#include <cstdint>

namespace hc::room {

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}

  /// The next number, 0 … 1.
  double next() {
    // splitmix64. Source: Steele, Lea, Flood, 2014.
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  /// The next number, least … most.
  double next(double least, double most) { return least + (most - least) * next(); }

 private:
  std::uint64_t state_;
};

}  // namespace hc::room
