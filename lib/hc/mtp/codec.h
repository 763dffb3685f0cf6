// SPDX-License-Identifier: Apache-2.0
#pragma once
// Encoding of messages (spec/mtp-1.md); stream_reader.h decodes them. Pure.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include <hc/mtp/header_memo.h>
#include <hc/mtp/message.h>

namespace hc {

/// An encoded message: pieces to be written in this order. They view memory of the encoder and the
/// message's elements.
using Pieces = std::array<std::span<const std::byte>, 3>;

/// Encodes messages in canonical form. Reuses its memory.
class Encoder {
 public:
  /// The pieces: header, elements (in place if they are binary or compressed), closing line feed.
  /// Elements that do not match the header are a bug.
  Pieces encode(const Message& message);

 private:
  internal::HeaderMemo memo_;
  std::string text_;
  std::array<char, kMaxHeaderBytes + 32> head_;
};

/// The encoded message as one string. For files and tests; links use Encoder.
std::string encode(const Message& message);

}  // namespace hc
