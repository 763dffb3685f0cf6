// SPDX-License-Identifier: Apache-2.0
#pragma once
// For tests: decodes one message from bytes in memory.

#include <algorithm>

#include <hc/mtp/stream_reader.h>

namespace hc {

/// Reads the first message in `bytes`; returns the bytes used, 0 if it is incomplete.
///
/// Errors: those of StreamReader.
inline Result<std::size_t> decode(std::span<const std::byte> bytes, Message& message,
                                  const Limits& limits = {}) {
  StreamReader reader(limits);
  while (true) {
    auto got = reader.next(message);
    if (!got) return got.error();
    if (*got) return static_cast<std::size_t>(reader.bytes());
    if (bytes.empty()) return std::size_t{0};
    const auto space = reader.space();
    const auto part = bytes.first(std::min(bytes.size(), space.size()));
    std::ranges::copy(part, space.begin());
    reader.commit(part.size());
    bytes = bytes.subspan(part.size());
  }
}

}  // namespace hc
