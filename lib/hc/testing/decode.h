// SPDX-License-Identifier: Apache-2.0
#pragma once
// A second reader of messages, for bytes that are all in memory: tests and fuzzers compare it with
// StreamReader.

#include <hc/mtp/decode.h>

namespace hc {

/// internal::decode() of one message, which a memo cannot help.
inline Result<std::size_t> decode(std::span<const std::byte> bytes, Message& message,
                                  const Limits& limits = {}, std::uint64_t byte = 0) {
  internal::HeaderMemo memo;
  return internal::decode(bytes, message, limits, byte, memo);
}

}  // namespace hc
