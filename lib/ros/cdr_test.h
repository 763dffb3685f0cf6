// SPDX-License-Identifier: Apache-2.0
#pragma once
// Bytes of CDR, for tests.

#include <initializer_list>
#include <vector>

#include <hc/testing/must.h>
#include <ros/cdr.h>

namespace hc::ros {

inline std::vector<std::byte> bytes_of(const Pieces& pieces) {
  std::vector<std::byte> all;
  for (const auto piece : {pieces.head, pieces.body, pieces.tail})
    all.insert(all.end(), piece.begin(), piece.end());
  return all;
}
inline std::vector<std::byte> octets(std::initializer_list<int> list) {
  std::vector<std::byte> all;
  for (const int each : list) all.push_back(static_cast<std::byte>(each));
  return all;
}
template <typename T>
std::vector<std::byte> cdr(const T& message) {
  return bytes_of(CdrWriter().write(message));
}

}  // namespace hc::ros
