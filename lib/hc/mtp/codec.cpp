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

}  // namespace

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
