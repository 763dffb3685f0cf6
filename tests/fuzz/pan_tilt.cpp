// SPDX-License-Identifier: Apache-2.0
// Any bytes from a pan-tilt unit: the same replies in pieces of any size. And any bytes to one:
// what it answers, as long as it does not echo, are replies.
#include <drivers/pan_tilt/protocol.h>
#include <drivers/pan_tilt/unit.h>

static std::string replies(std::string_view bytes, std::size_t piece, bool may_fail = true) {
  hc::pan_tilt::ReplyReader reader;
  std::string all;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    reader.feed(bytes.substr(at, piece));
    while (auto reply = reader.next()) {
      HC_CHECK(may_fail || *reply, bytes);
      all += *reply ? std::to_string(int((*reply)->kind)) + (*reply)->text : reply->error().text();
    }
  }
  return all;
}

int fuzz_pan_tilt(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  HC_CHECK(replies(bytes, size + 1) == replies(bytes, size == 0 ? 1 : 1 + data[0] % 7U), bytes);
  hc::pan_tilt::Unit unit;
  std::string said = unit.take(0, "ed ").substr(3);
  for (std::size_t i = 0; i < size; ++i) said += unit.take(0.01 * double(i), bytes.substr(i, 1));
  replies(said, size + 1, bytes.find_first_of("eE") != std::string_view::npos);
  HC_CHECK(unit.pan(1e9) > -1e5 && unit.pan(1e9) < 1e5, bytes);
  return 0;
}
