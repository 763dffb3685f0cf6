// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/codec.h>

#include <string_view>

#include <hc/mtp/digits.h>
#include <hc/mtp/framing.h>
#include <hc/mtp/text.h>

namespace hc {

Pieces Encoder::encode(const Message& message) {
  const Header& header = message.header;
  HC_CHECK(!message.plain() || message.elements.size() == header.element_bytes(), text(header),
           message.elements.size());
  std::size_t size =
      memo_.format(header, std::span<char, kMaxHeaderBytes>(head_.data(), kMaxHeaderBytes));
  if (internal::has_rows(header)) {
    text_.assign(head_.data(), size);
    append_text(header, message.elements, text_);
    return {std::as_bytes(std::span(text_)), {}, {}};
  }
  if (internal::is_compressed(header)) {
    char* end = internal::write_integer(head_.data() + size, message.elements.size());
    *end++ = '\n';
    size = static_cast<std::size_t>(end - head_.data());
  }
  return {std::as_bytes(std::span(head_).first(size)), message.elements,
          std::as_bytes(std::span("\n", 1))};
}

std::string encode(const Message& message) {
  Encoder encoder;
  std::string bytes;
  for (auto piece : encoder.encode(message))
    bytes.append(reinterpret_cast<const char*>(piece.data()), piece.size());
  return bytes;
}

}  // namespace hc
