// SPDX-License-Identifier: Apache-2.0
#pragma once
// Compares two recordings of an output. Pure.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include <hc/mtp/message.h>

namespace tool {

/// Allowed differences.
struct Tolerance {
  double number = 0;  ///< difference of numbers
  double share = 1;   ///< least share of equal messages
};

/// The first field in which two messages differ, with both values: "width: 4 recorded, 5 replayed".
/// Ignores src, seq and time; empty if equal. Elements must not be compressed.
std::string difference(const hc::Message& recorded, const hc::Message& replayed,
                       const Tolerance& tolerance);

struct Comparison {
  std::size_t recorded = 0;   ///< messages
  std::size_t same = 0;       ///< recorded messages that were replayed
  std::size_t differing = 0;  ///< replayed with other contents at that time
  std::size_t missing = 0;    ///< recorded but not replayed
  std::size_t extra = 0;      ///< replayed but not recorded
  std::size_t after_end = 0;  ///< recorded after `last`, and not replayed
  std::string first;          ///< the first difference; empty: none

  [[nodiscard]] bool is_same(const Tolerance& tolerance) const;
  [[nodiscard]] std::string text() const;
};

/// Returns the next message, uncompressed, in memory that the caller may keep; false at the end.
using NextMessage = std::function<bool(hc::Message&)>;

/// Compares messages of equal time, one to one; times within a recording may go back by 1 s at
/// most.
/// @param last  the `seq` of the last recorded message that a replay must reproduce.
Comparison compare(const NextMessage& recorded, const NextMessage& replayed,
                   const Tolerance& tolerance,
                   std::int64_t last = std::numeric_limits<std::int64_t>::max());

}  // namespace tool
