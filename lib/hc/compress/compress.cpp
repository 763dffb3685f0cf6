// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/compress.h>

#include <string>

#include <hc/compress/codecs.h>

namespace hc {
namespace internal {

Error damaged(int rule, std::string_view what, const Message& message) {
  return {Code::Malformed, "R" + std::to_string(rule) + " elements: " + std::string(what) +
                               ", at byte " + std::to_string(message.byte)};
}

Error too_few_bytes(int rule, const Message& message) {
  return damaged(rule,
                 std::to_string(message.elements.size()) +
                     " compressed bytes cannot expand to the header's " +
                     std::to_string(message.header.element_bytes()) + " bytes",
                 message);
}

Error no_codec(std::string_view encoding, std::string_view package) {
  return {Code::Unsupported, "this build does not support " + std::string(encoding) + "; install " +
                                 std::string(package) + " and rebuild"};
}

Message plain_message(const Message& message, const SharedBytes& bytes) {
  Message result{
      message.header, {bytes.get(), message.header.element_bytes()}, bytes, message.byte};
  result.header.info.encoding = Encoding::Binary;
  return result;
}

}  // namespace internal

Result<Message> expand(const Message& message) {
  switch (message.header.info.encoding) {
    case Encoding::Text:
    case Encoding::Binary:
      return message;
    case Encoding::Zstd:
      return internal::expand_zstd(message);
    case Encoding::Jpeg:
      break;
  }
  return internal::expand_jpeg(message);
}

Result<Message> compress(const Message& message, Encoding encoding, int jpeg_quality) {
  if (message.header.info.encoding == encoding) return message;
  auto plain = HC_TRY(expand(message));
  plain.header.info.encoding = encoding;
  if (auto valid = check(plain.header, {~std::uint64_t{0}}); !valid)
    return Error{Code::Unsupported, valid.error().detail};
  switch (encoding) {
    case Encoding::Text:
    case Encoding::Binary:
      return plain;
    case Encoding::Zstd:
      return internal::compress_zstd(plain);
    case Encoding::Jpeg:
      break;
  }
  return internal::compress_jpeg(plain, jpeg_quality);
}

}  // namespace hc
