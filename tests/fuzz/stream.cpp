// SPDX-License-Identifier: Apache-2.0
// Any stream: in pieces of any size and in large ones it gives the same messages and the same
// error; what was read is written and read as itself.
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

/// A stream that comes in pieces.
struct Stream {
  std::span<const std::byte> bytes;
  std::size_t piece;
  hc::StreamReader reader;

  hc::Result<bool> next(hc::Message& message) {
    while (true) {
      auto got = reader.next(message);
      if (!got || *got || bytes.empty()) return got;
      auto space = reader.space();
      std::size_t part = std::min({space.size(), piece, bytes.size()});
      std::memcpy(space.data(), bytes.data(), part);
      reader.commit(part);
      bytes = bytes.subspan(part);
    }
  }
};

}  // namespace

int fuzz_stream(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  constexpr std::size_t kWhole = 65536;
  auto bytes = std::as_bytes(std::span(data + 1, size - 1));
  hc::Limits limits{std::uint64_t{1} << 20};
  Stream in_pieces{bytes, data[0] == 0 ? kWhole : data[0], hc::StreamReader(limits)};
  Stream in_one{bytes, kWhole, hc::StreamReader(limits)};
  hc::Message read, whole;
  while (true) {
    auto got = in_pieces.next(read), other = in_one.next(whole);
    HC_CHECK(other.has_value() == got.has_value());
    if (!got) {
      HC_CHECK(other.error().detail == got.error().detail, other.error().detail,
               got.error().detail);
      return 0;
    }
    HC_CHECK(*other == *got);
    if (!*got) break;
    HC_CHECK(in_pieces.reader.bytes() == in_one.reader.bytes());
    check_same(read, whole);
    std::string again = hc::encode(read);
    hc::Message reread;
    auto reused = hc::decode(std::as_bytes(std::span(again)), reread, limits);
    HC_CHECK(reused && *reused == again.size());
    check_same(read, reread);
  }
  HC_CHECK(in_pieces.reader.finish().has_value() == in_one.reader.finish().has_value());
  return 0;
}
