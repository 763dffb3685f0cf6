// SPDX-License-Identifier: Apache-2.0
// Any message with compressed elements: it expands to just what its header promises, or is refused.
#include <hc/compress/compress.h>
#include <hc/mtp/codec.h>
#include <hc/testing/decode.h>

int fuzz_compressed(const std::uint8_t* data, std::size_t size) {
  hc::Message message;
  auto used =
      hc::decode(std::as_bytes(std::span(data, size)), message, hc::Limits{std::uint64_t{1} << 20});
  if (!used || *used == 0) return 0;
  auto plain = hc::expand(message);
  if (!plain) return 0;
  HC_CHECK(plain->plain() && plain->elements.size() == plain->header.element_bytes());
  auto packed = hc::compress(*plain, hc::Encoding::Zstd);
  HC_CHECK(packed.has_value());
  auto again = hc::expand(*packed);
  HC_CHECK(again && hc::encode(*again).size() == hc::encode([&] {
                                                   auto binary = *plain;
                                                   binary.header.info.encoding =
                                                       hc::Encoding::Binary;
                                                   return binary;
                                                 }())
                                                     .size());
  return 0;
}
