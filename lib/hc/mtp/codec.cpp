// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/codec.h>

#include <cstring>
#include <string_view>

#include <hc/mtp/digits.h>
#include <hc/mtp/framing.h>
#include <hc/mtp/text.h>

namespace hc {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

bool is_aligned(const char* at, Scalar scalar) {
  return reinterpret_cast<std::uintptr_t>(at) % size_of(scalar) == 0;
}

}  // namespace

Result<std::size_t> decode(std::span<const std::byte> bytes, Message& message, const Limits& limits,
                           std::uint64_t byte) {
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
      return internal::check_rows(header, rest.substr(at), byte + at);
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
  message = {header, bytes_of(elements), nullptr, elements_byte};
  if (message.plain() && !is_aligned(elements.data(), header.info.scalar)) message = message.keep();
  return at + *end;
}

Pieces Encoder::encode(const Message& message) {
  const Header& header = message.header;
  HC_CHECK(!message.plain() || message.elements.size() == header.element_bytes(), text(header),
           message.elements.size());
  std::size_t size =
      memo_.format(header, std::span<char, kMaxHeaderBytes>(head_.data(), kMaxHeaderBytes));
  if (internal::has_rows(header)) {
    text_.assign(head_.data(), size);
    append_text(header, message.elements, text_);
    return {bytes_of(text_), {}, {}};
  }
  if (internal::is_compressed(header)) {
    char* end = internal::write_digits(head_.data() + size, message.elements.size());
    *end++ = '\n';
    size = static_cast<std::size_t>(end - head_.data());
  }
  return {bytes_of({head_.data(), size}), message.elements, bytes_of("\n")};
}

std::string encode(const Message& message) {
  Encoder encoder;
  std::string bytes;
  for (auto piece : encoder.encode(message))
    bytes.append(reinterpret_cast<const char*>(piece.data()), piece.size());
  return bytes;
}

}  // namespace hc
