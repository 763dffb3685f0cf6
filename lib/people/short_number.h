// SPDX-License-Identifier: Apache-2.0
#pragma once
// Numbers of rows that people read, without digits that mean nothing. Pure.

#include <cmath>

namespace hc::people {

/// To 0.01. [px]
inline double short_pixel(double number) {
  return std::round(number * 100) / 100;
}
/// To 0.0001: [m], [rad], and shares.
inline double short_number(double number) {
  return std::round(number * 10'000) / 10'000;
}

}  // namespace hc::people
