// SPDX-License-Identifier: Apache-2.0
#include "json.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace tool {
namespace {

/// The JSON form without a line end.
std::string to_json(const hc::Message& message) {
  std::string json;
  write_json(message, message.header, [&](std::string_view piece) {
    json += piece;
    return true;
  });
  json.pop_back();
  return json;
}

// spec/vectors has the other cases; tests/conformance reads them with hc cat --json.

TEST(Json, IsOneLineOfNamedFields) {
  hc::Draft draft = hc::Draft::make(hc::Info(), 1, 1);
  auto numbers = draft.view<double>().numbers();
  numbers[0] = 0.5;
  numbers[1] = -0.0;
  numbers[2] = 1e300 * 1e10;
  EXPECT_EQ(
      to_json(std::move(draft).finish()),
      "{\"version\":1,\"src\":0,\"dst\":0,\"seq\":0,\"ttl\":8,\"time\":0,\"info\":10390,"
      "\"mode\":0,\"coord\":0,\"width\":1,\"height\":1,\"type\":\"position\",\"components\":3,"
      "\"scalar\":\"f64\",\"encoding\":\"text\",\"elements\":[[[0.5,-0,\"inf\"]]]}");
}

TEST(Json, IsWrittenInPieces) {
  const auto message = std::move(hc::Draft::make(hc::Info{hc::MatrixType::IntensityImage, 1,
                                                          hc::Scalar::U8, hc::Encoding::Binary}, 1000, 1000))
                           .finish();
  std::size_t largest = 0, all = 0;
  EXPECT_TRUE(write_json(message, message.header, [&](std::string_view piece) {
    largest = std::max(largest, piece.size());
    all += piece.size();
    return true;
  }));
  EXPECT_LT(largest, 100'000);
  EXPECT_EQ(all, to_json(message).size() + 1);
  int pieces = 0;
  EXPECT_FALSE(write_json(message, message.header, [&](auto) { return ++pieces < 3; }));
  EXPECT_EQ(pieces, 3);
}

TEST(Json, CompressedIsNull) {
  hc::Message message = std::move(hc::Draft::make(hc::Info(), 1, 1)).finish();
  message.header.info.encoding = hc::Encoding::Zstd;
  EXPECT_TRUE(to_json(message).ends_with("\"elements\":null}"));
}

}  // namespace
}  // namespace tool
