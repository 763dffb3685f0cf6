// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages to bytes and back, where all bytes are in memory (spec/mtp-1.md). Pure.
// stream_reader.h reads what comes in pieces.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <hc/base/result.h>
#include <hc/mtp/header_memo.h>
#include <hc/mtp/message.h>

namespace hc {

/// Reads the first message in `bytes`.
///
///     Message message;
///     auto used = decode(bytes, message);
///     if (!used) return used.error();       // refused
///     if (*used == 0) return read_more();   // not complete yet
///
/// @param bytes  start of a stream; less or more than one message.
/// @param[out] message  set when the result is > 0. Its elements view `bytes` where they stand
/// there
///     in binary form and aligned for their scalar (as u8 always is); others are copied.
/// @param byte  where `bytes` stand in their stream, for errors.
/// @returns  bytes used; 0 when the message is not complete yet.
///
/// Errors: Malformed, Unsupported, TooLarge; the detail names rule, field and byte.
/// Cost: no allocation for a message that views `bytes`, nor before the message is complete.
Result<std::size_t> decode(std::span<const std::byte> bytes, Message& message,
                           const Limits& limits = {}, std::uint64_t byte = 0);

/// A message as it goes onto a wire: pieces to be written one after the other.
/// Lives no longer than the encoder that gave it and the message's elements.
using Pieces = std::array<std::span<const std::byte>, 3>;

/// Writes messages in canonical form. Keeps its memory from one message to the next.
class Encoder {
 public:
  /// The pieces of `message`: header, elements (in place when they are binary or compressed), end.
  /// A message whose elements do not match its header is a bug.
  Pieces encode(const Message& message);

 private:
  internal::HeaderMemo memo_;
  std::string text_;
  std::array<char, kMaxHeaderBytes + 32> head_;
};

/// The bytes of a message, all in one. For files and tests; links use Encoder.
std::string encode(const Message& message);

}  // namespace hc
