// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/compress.h>

#include <zstd.h>
#include <zstd_errors.h>

#include <string>

#include <hc/compress/jpeg.h>

namespace hc {
namespace {

Error damaged(int rule, std::string_view what, const Message& message) {
  return {Code::Malformed, "R" + std::to_string(rule) + " elements: " + std::string(what) +
                               ", at byte " + std::to_string(message.byte)};
}

Result<Message> plain_message(const Message& message, const SharedBytes& bytes) {
  Message result{
      message.header, {bytes.get(), message.header.element_bytes()}, bytes, message.byte};
  result.header.info.encoding = Encoding::Binary;
  return result;
}

/// Most bytes that one compressed byte can stand for, so that no memory is set aside for a promise
/// that what came cannot keep. A block of zstd takes 4 bytes at least, 3 of them its head, and
/// holds 128 KiB at most (RFC 8878, 3.1.1.2). One component of a JPEG picture has all pixels, in
/// blocks of 64 that take a bit each at least (ITU-T T.81, A.1.1 and F.1.2).
constexpr std::uint64_t kMostForZstd = (std::uint64_t{128} << 10) / 4;
constexpr std::uint64_t kMostForJpeg = std::uint64_t{64} * 8;

Error too_few(int rule, std::uint64_t promised, const Message& message) {
  return damaged(rule,
                 std::to_string(message.elements.size()) + " compressed bytes cannot hold the " +
                     std::to_string(promised) + " bytes that the header promises",
                 message);
}

Result<Message> expand_zstd(const Message& message) {
  std::uint64_t promised = message.header.element_bytes();
  if (message.elements.empty()) return damaged(36, "no zstd frame", message);
  if (promised / kMostForZstd > message.elements.size()) return too_few(36, promised, message);
  // All in one call: it writes into our bytes alone, needs no window, and stops at their end.
  SharedBytes bytes = allocate_bytes(promised);
  std::size_t size =
      ZSTD_decompress(bytes.get(), promised, message.elements.data(), message.elements.size());
  if (ZSTD_getErrorCode(size) == ZSTD_error_dstSize_tooSmall)
    return damaged(36,
                   "the zstd frames hold more than the " + std::to_string(promised) +
                       " bytes that the header promises",
                   message);
  if (ZSTD_isError(size) != 0)
    return damaged(36, std::string("zstd: ") + ZSTD_getErrorName(size), message);
  if (size != promised)
    return damaged(36,
                   "the zstd frames hold " + std::to_string(size) + " bytes, the header promises " +
                       std::to_string(promised),
                   message);
  return plain_message(message, bytes);
}

Result<Message> compress_zstd(const Message& message, int level) {
  std::size_t bound = ZSTD_compressBound(message.elements.size());
  SharedBytes bytes = allocate_bytes(bound);
  std::size_t size =
      ZSTD_compress(bytes.get(), bound, message.elements.data(), message.elements.size(), level);
  HC_CHECK(ZSTD_isError(size) == 0, ZSTD_getErrorName(size));
  return Message{message.header, {bytes.get(), size}, bytes, 0};
}

}  // namespace

Result<Message> expand(const Message& message) {
  switch (message.header.info.encoding) {
    case Encoding::Text:
    case Encoding::Binary:
      return message;
    case Encoding::Zstd:
      return expand_zstd(message);
    case Encoding::Jpeg:
      break;
  }
  std::uint64_t promised = message.header.element_bytes();
  if (promised / message.header.info.components / kMostForJpeg > message.elements.size())
    return too_few(37, promised, message);
  SharedBytes pixels = allocate_bytes(promised);
  if (auto fault = internal::read_jpeg(message.elements, message.header, pixels.get()))
    return damaged(37, *fault, message);
  return plain_message(message, pixels);
}

Result<Message> compress(const Message& message, Encoding encoding,
                         const CompressOptions& options) {
  if (message.header.info.encoding == encoding) return message;
  auto plain = expand(message);
  if (!plain) return plain.error();
  plain->header.info.encoding = encoding;
  if (auto valid = check(plain->header, {~std::uint64_t{0}}); !valid)
    return Error{Code::Unsupported, valid.error().detail};
  switch (encoding) {
    case Encoding::Text:
    case Encoding::Binary:
      return plain;
    case Encoding::Zstd:
      return compress_zstd(*plain, options.zstd_level);
    case Encoding::Jpeg:
      break;
  }
  return internal::write_jpeg(*plain, options.jpeg_quality);
}

}  // namespace hc
