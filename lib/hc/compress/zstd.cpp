// SPDX-License-Identifier: Apache-2.0
#include <zstd.h>
#include <zstd_errors.h>

#include <string>

#include <hc/base/check.h>
#include <hc/compress/codecs.h>

namespace hc::internal {
namespace {

/// Maximum expansion ratio, to refuse impossible headers before memory is allocated: a zstd block
/// takes at least 4 bytes, 3 of them its header, and holds at most 128 KiB (RFC 8878, 3.1.1.2).
constexpr std::uint64_t kMaxExpansion = (std::uint64_t{128} << 10) / 4;
/// Messages larger than kLarge are limited to this ratio, which flat images do not exceed: a few
/// thousand bytes must not make a reader allocate hundreds of megabytes.
constexpr std::uint64_t kLarge = std::uint64_t{64} << 20, kMaxLargeExpansion = 256;

}  // namespace

Result<Message> expand_zstd(const Message& message) {
  std::uint64_t promised = message.header.element_bytes();
  if (message.elements.empty()) return damaged(36, "no zstd frame", message);
  if (promised / kMaxExpansion > message.elements.size()) return too_few_bytes(36, message);
  if (promised > kLarge && promised / kMaxLargeExpansion > message.elements.size())
    return Error{Code::TooLarge, "R36 elements: " + std::to_string(message.elements.size()) +
                                     " compressed bytes for " + std::to_string(promised) +
                                     " exceed the ratio of 1 to " +
                                     std::to_string(kMaxLargeExpansion) + ", at byte " +
                                     std::to_string(message.byte)};
  // The one-shot call needs no window and stops at the end of our buffer.
  SharedBytes bytes = allocate_bytes(promised);
  std::size_t size =
      ZSTD_decompress(bytes.get(), promised, message.elements.data(), message.elements.size());
  if (ZSTD_getErrorCode(size) == ZSTD_error_dstSize_tooSmall)
    return damaged(
        36, "the zstd frames contain more than the header's " + std::to_string(promised) + " bytes",
        message);
  if (ZSTD_isError(size) != 0)
    return damaged(36, std::string("zstd: ") + ZSTD_getErrorName(size), message);
  if (size != promised)
    return damaged(36,
                   "the zstd frames contain " + std::to_string(size) + " bytes, not the header's " +
                       std::to_string(promised),
                   message);
  return plain_message(message, bytes);
}

Result<Message> compress_zstd(const Message& message) {
  constexpr int kFast = 1;  // level, of 1 (fast) to 19 (small)
  std::size_t bound = ZSTD_compressBound(message.elements.size());
  SharedBytes bytes = allocate_bytes(bound);
  std::size_t size =
      ZSTD_compress(bytes.get(), bound, message.elements.data(), message.elements.size(), kFast);
  HC_CHECK(ZSTD_isError(size) == 0, ZSTD_getErrorName(size));
  return Message{message.header, {bytes.get(), size}, bytes, 0};
}

}  // namespace hc::internal
