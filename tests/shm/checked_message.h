// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages that tell whether they are whole: the header's `time` is a checksum over its src and seq
// and over the elements. Pure.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include <hc/link/link.h>

namespace hc::testing {

/// What the header of a message with these elements has as its time.
inline std::int64_t checksum(const Header& header, std::span<const std::byte> elements) {
  constexpr std::uint64_t kPrime = 0x9E3779B97F4A7C15;
  std::uint64_t sum = (static_cast<std::uint64_t>(header.src) << 40 ^
                       static_cast<std::uint64_t>(header.seq) ^ elements.size() << 20) *
                      kPrime;
  auto add = [&](std::uint64_t word) {
    sum = (sum ^ word) * kPrime;
    sum ^= sum >> 29;
  };
  while (elements.size() >= sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, elements.data(), sizeof word);
    add(word);
    elements = elements.subspan(sizeof word);
  }
  std::uint64_t rest = 0;
  if (!elements.empty()) std::memcpy(&rest, elements.data(), elements.size());
  add(rest);
  return static_cast<std::int64_t>(sum >> 1);  // a time is not negative
}

inline bool is_whole(const Message& message) {
  return message.elements.size() == message.header.element_bytes() &&
         unix_nanoseconds(message.header.time) == checksum(message.header, message.elements);
}

/// A message of `bytes` that no other message of any publisher looks like, in memory of the sink
/// if it lends any.
///
/// @param src  a number of the publisher.
inline Message make_checked(Sink* sink, std::int32_t src, std::int64_t seq, std::int32_t bytes) {
  Header header;
  header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
  header.src = src;
  header.seq = seq;
  header.width = bytes;
  header.height = 1;
  Draft draft = sink != nullptr ? sink->loan(header) : Draft::make(header);
  auto elements = draft.elements();
  auto word = static_cast<std::uint64_t>(src) * 1'000'003 + static_cast<std::uint64_t>(seq) * 7919;
  for (std::size_t at = 0; at < elements.size(); at += sizeof word, word += 0x0101'0101'0101'0101)
    std::memcpy(elements.data() + at, &word, std::min(sizeof word, elements.size() - at));
  draft.header.time = unix_time(checksum(header, elements));
  return std::move(draft).finish();
}

/// One number that orders the messages of publishers 0, 1, 2, … .
inline std::int64_t place_of(const Header& header) {
  return static_cast<std::int64_t>(header.src) << 40 | header.seq;
}

}  // namespace hc::testing
