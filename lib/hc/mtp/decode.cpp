// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/decode.h>

#include <array>
#include <string_view>
#include <utility>

#include <hc/mtp/framing.h>
#include <hc/mtp/text.h>

namespace hc::internal {
namespace {

/// Reads rows that are not complete for their errors alone; gives 0, or the first error.
Result<std::size_t> check_rows(const Header& header, std::string_view text, std::uint64_t byte) {
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

}  // namespace

Result<std::size_t> decode(std::span<const std::byte> bytes, Message& message, const Limits& limits,
                           std::uint64_t byte, HeaderMemo& memo) {
  std::string_view rest{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  auto line = read_header_line(rest, limits, byte, memo);
  if (!line) return line.error();
  if (line->bytes == 0) return std::size_t{0};
  const Header& header = line->header;
  std::size_t at = line->bytes;

  if (has_rows(header)) {
    // A number takes two bytes at least, so nothing is allocated for numbers that have not come.
    std::uint64_t numbers = header.row_numbers() * static_cast<std::uint64_t>(header.height);
    if (rest.size() - at < 2 * numbers) return check_rows(header, rest.substr(at), byte + at);
    Draft draft = Draft::make(header);
    TextRows rows(header);
    auto used = rows.read(rest.substr(at), byte + at, draft.elements().data());
    if (!used) return used.error();
    if (!rows.done()) return std::size_t{0};
    message = std::move(draft).finish();
    message.byte = byte + at;
    return at + *used;
  }

  std::uint64_t length = header.element_bytes();
  if (is_compressed(header)) {
    auto part = read_length_line(rest.substr(at), limits, byte + at);
    if (!part) return part.error();
    if (part->bytes == 0) return std::size_t{0};
    at += part->bytes;
    length = part->length;
  }
  if (rest.size() - at < length) return std::size_t{0};
  const std::uint64_t end = at + length;
  auto closing = read_closing(header, rest.substr(end), byte + end);
  if (!closing) return closing.error();
  if (*closing == 0) return std::size_t{0};
  message = {header, bytes.subspan(at, length), nullptr, byte + at};
  if (message.plain() &&
      reinterpret_cast<std::uintptr_t>(message.elements.data()) % size_of(header.info.scalar) != 0)
    message = message.keep();
  return end + *closing;
}

}  // namespace hc::internal
