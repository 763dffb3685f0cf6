// SPDX-License-Identifier: Apache-2.0
#pragma once
// A second reader of messages, for bytes that are all in memory: tests and fuzzers compare it with
// StreamReader.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <hc/mtp/framing.h>
#include <hc/mtp/message.h>
#include <hc/mtp/text.h>

namespace hc {
namespace testing {

/// Reads rows that are not complete for their errors alone; gives 0, or the first error.
inline Result<std::size_t> check_rows(const Header& header, std::string_view text,
                                      std::uint64_t byte) {
  constexpr std::size_t kPiece = 4096;
  alignas(8) std::array<std::byte, (kPiece / 2 + 1) * 8> numbers;
  TextRows rows(header);
  std::size_t at = 0;
  while (at < text.size()) {
    auto used = rows.read(text.substr(at, kPiece), byte + at, numbers.data());
    if (!used) return used.error();
    if (*used == 0) break;
    at += *used;
  }
  return std::size_t{0};
}

}  // namespace testing

/// Reads the first message in `bytes`.
///
///     Message message;
///     auto used = decode(bytes, message);
///     if (!used) return used.error();       // refused
///     if (*used == 0) return read_more();   // not complete yet
///
/// @param bytes  start of a stream; less or more than one message.
/// @param[out] message  set when the result is > 0. Its elements view `bytes` where they are
///     in binary form and aligned for their scalar (as u8 always is); others are copied.
/// @param byte  where `bytes` stand in their stream, for errors.
/// @returns  bytes used; 0 when the message is not complete yet.
///
/// Errors: Malformed, Unsupported, TooLarge; the detail names rule, field and byte.
/// Cost: no allocation for a message that views `bytes`, nor before the message is complete.
inline Result<std::size_t> decode(std::span<const std::byte> bytes, Message& message,
                                  const Limits& limits = {}, std::uint64_t byte = 0) {
  std::string_view rest{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  internal::HeaderMemo memo;  // of one line, which it cannot help
  auto line = internal::read_header_line(rest, limits, byte, memo);
  if (!line) return line.error();
  if (line->bytes == 0) return std::size_t{0};
  const Header& header = line->header;
  std::size_t at = line->bytes;

  if (internal::has_rows(header)) {
    // A number takes two bytes at least, so nothing is allocated for numbers that have not come.
    std::uint64_t numbers = header.row_numbers() * static_cast<std::uint64_t>(header.height);
    if (rest.size() - at < 2 * numbers)
      return testing::check_rows(header, rest.substr(at), byte + at);
    Draft draft = Draft::make(header);
    TextRows rows(header);
    auto used = rows.read(rest.substr(at), byte + at, draft.elements().data());
    if (!used) return used.error();
    message = std::move(draft).finish();
    return rows.done() ? at + *used : std::size_t{0};
  }

  std::uint64_t length = header.element_bytes();
  if (internal::is_compressed(header)) {
    auto part = internal::read_length_line(rest.substr(at), limits, byte + at);
    if (!part) return part.error();
    if (part->bytes == 0) return std::size_t{0};
    at += part->bytes;
    length = part->length;
  }
  if (rest.size() - at < length) return std::size_t{0};
  auto elements = rest.substr(at, length);
  std::uint64_t elements_byte = byte + at;
  at += length;
  auto end = internal::read_closing(header, rest.substr(at), byte + at);
  if (!end) return end.error();
  if (*end == 0) return std::size_t{0};
  message = {header, std::as_bytes(std::span(elements)), nullptr, elements_byte};
  if (message.plain() &&
      reinterpret_cast<std::uintptr_t>(elements.data()) % size_of(header.info.scalar) != 0)
    message = message.keep();
  return at + *end;
}

}  // namespace hc
