// SPDX-License-Identifier: Apache-2.0
#pragma once
// Whether two recordings of one output say the same, and where they first do not. Pure.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include <hc/mtp/message.h>

namespace tool {

/// What may differ.
struct Tolerance {
  double number = 0;      ///< numbers, by so much
  std::int64_t time = 0;  ///< when a message is sent, either way [ns]
  double share = 1;       ///< of the messages, so many are the same
};

/// The first field in which two messages differ, with both values: "width: 4 recorded, 5 replayed";
/// empty where they are the same but for src, seq and time. Elements must not be compressed.
std::string difference(const hc::Message& recorded, const hc::Message& replayed,
                       const Tolerance& tolerance);

struct Comparison {
  std::size_t recorded = 0, replayed = 0;  ///< messages
  std::size_t same = 0;                    ///< of the recorded ones
  std::size_t differing = 0;               ///< another of that time was sent in their place
  std::size_t missing = 0;                 ///< recorded and not replayed
  std::size_t extra = 0;                   ///< replayed and not recorded
  std::size_t after_end = 0;               ///< recorded after `last`, and not replayed
  std::string first;                       ///< where they first differ; empty: nowhere

  [[nodiscard]] bool is_same(const Tolerance& tolerance) const;
  [[nodiscard]] std::string text() const;
};

/// Gives the next message, plain and to be kept; false at the end.
using NextMessage = std::function<bool(hc::Message&)>;

/// Compares messages of equal times, or where a tolerance allows, with any that is so near; the
/// times of a recording may go back by a second at most.
/// @param last  the `seq` of the last recorded message that was to be replayed
Comparison compare(const NextMessage& recorded, const NextMessage& replayed,
                   const Tolerance& tolerance,
                   std::int64_t last = std::numeric_limits<std::int64_t>::max());

}  // namespace tool
