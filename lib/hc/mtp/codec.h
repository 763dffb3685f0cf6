// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages to bytes (spec/mtp-1.md). Pure. stream_reader.h is the way back.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include <hc/mtp/header_memo.h>
#include <hc/mtp/message.h>

namespace hc {

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
