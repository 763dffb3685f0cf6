// SPDX-License-Identifier: Apache-2.0
// Any stream: StreamReader in pieces of any size and decode() on the whole give the same messages
// and the same error; what was read is written and read as itself.
#include <algorithm>
#include <cstring>

#include <hc/mtp/codec.h>
#include <hc/mtp/stream_reader.h>
#include <hc/testing/decode.h>

namespace {

/// Bytes of floats that are not-a-number need not survive text, so text is compared as text.
void check_same(const hc::Message& a, const hc::Message& b) {
  HC_CHECK(a.header == b.header);
  HC_CHECK(hc::encode(a) == hc::encode(b));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  std::size_t piece = data[0] == 0 ? 65536 : data[0];
  auto bytes = std::as_bytes(std::span(data + 1, size - 1));
  hc::Limits limits{std::uint64_t{1} << 20};
  hc::StreamReader reader(limits);
  std::size_t fed = 0, decoded = 0;
  hc::Message read, whole;
  while (true) {
    auto got = reader.next(read);
    if (got && !*got && fed < bytes.size()) {
      auto space = reader.space();
      std::size_t part = std::min({space.size(), piece, bytes.size() - fed});
      std::memcpy(space.data(), bytes.data() + fed, part);
      reader.commit(part);
      fed += part;
      continue;
    }
    auto used = hc::decode(bytes.subspan(decoded), whole, limits, decoded);
    HC_CHECK(used.has_value() == got.has_value());
    if (!got) {
      HC_CHECK(used.error().detail == got.error().detail, used.error().detail, got.error().detail);
      return 0;
    }
    HC_CHECK((*used > 0) == *got);
    if (!*got) break;
    decoded += *used;
    check_same(read, whole);
    std::string again = hc::encode(read);
    hc::Message reread;
    auto reused = hc::decode(std::as_bytes(std::span(again)), reread, limits);
    HC_CHECK(reused && *reused == again.size());
    check_same(read, reread);
  }
  HC_CHECK(reader.finish().has_value() == (decoded == bytes.size()));
  return 0;
}
