// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/codec.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <hc/mtp/matrix_view.h>
#include <hc/mtp/stream_reader.h>
#include <hc/testing/decode.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

/// A random small message of any type, scalar and plain encoding.
Message random_message(std::mt19937_64& random) {
  auto pick = [&](std::uint64_t count) { return random() % count; };
  Header header;
  do {
    header.info = {static_cast<MatrixType>(1 + pick(12)), static_cast<std::uint8_t>(1 + pick(9)),
                   static_cast<Scalar>(pick(10)), static_cast<Encoding>(pick(2))};
  } while (find_error(header.info));
  header.src = static_cast<std::int32_t>(random() >> (33 + pick(31)));
  header.dst = static_cast<std::int32_t>(random());
  header.seq = static_cast<std::int64_t>(random() >> (1 + pick(63)));
  header.ttl = static_cast<std::uint8_t>(random());
  header.time = unix_time(static_cast<std::int64_t>(random() >> (1 + pick(63))));
  header.coord = static_cast<std::int32_t>(random() >> (33 + pick(31)));
  header.width = static_cast<std::int32_t>(pick(4));
  header.height = static_cast<std::int32_t>(pick(4));
  if (header.info.type == MatrixType::SparseGraph) header.width = 1;
  if (header.info.type == MatrixType::DenseGraph) header.height = header.width;
  Draft draft = Draft::make(header);
  for (auto& byte : draft.elements()) byte = static_cast<std::byte>(random());
  if (header.info.encoding == Encoding::Text) {
    // Text loses the sign and payload of NaN.
    auto clean = [&](auto zero) {
      for (auto& number : view<decltype(zero)>(draft).numbers())
        if (std::isnan(number)) number = std::numeric_limits<decltype(zero)>::quiet_NaN();
    };
    if (header.info.scalar == Scalar::F64) clean(double{});
    if (header.info.scalar == Scalar::F32) clean(float{});
  }
  return std::move(draft).finish();
}

TEST(Codec, AMillionRandomMessagesComeBackToTheBit) {
  std::mt19937_64 random(3);
  Message again;
  for (int i = 0; i < 1'000'000; ++i) {
    Message message = random_message(random);
    std::string bytes = encode(message);
    auto used = must(decode(bytes_of(bytes), again));
    ASSERT_EQ(used, bytes.size());
    ASSERT_EQ(again.header, message.header);
    ASSERT_EQ(again.text(), message.text()) << bytes;
    ASSERT_EQ(encode(again), bytes);
  }
}

TEST(Codec, ElementsAreAlwaysAligned) {
  for (std::size_t shift = 0; shift < 8; ++shift) {
    std::string bytes =
        encode(std::move(Draft::make({MatrixType::Table, 1, Scalar::F64, Encoding::Binary}, 1, 3))
                   .finish());
    bytes.insert(0, shift, ' ');  // spaces before a header are allowed
    Message message;
    ASSERT_EQ(*decode(bytes_of(bytes), message), bytes.size());
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(message.elements.data()) % 8, 0U);
  }
}

TEST(Codec, IncompleteIsNoError) {
  for (const char* text :
       {"1 7 0 0 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n", "1 7 0 0 8 0 40102 1 7 1 1\n3\nabc\n",
        "1 7 0 0 8 0 60100 1 30 2 1\nok\r\n"}) {
    std::string bytes = text;
    Message message;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      auto used = must(decode(bytes_of(bytes.substr(0, size)), message));
      EXPECT_EQ(used, 0U) << size;
    }
    EXPECT_EQ(*decode(bytes_of(bytes), message), bytes.size());
  }
}

TEST(CodecDeathTest, ElementsThatAreNotWhatTheHeaderSaysAreABug) {
  Message message = std::move(Draft::make(Info(), 1, 1)).finish();
  message.header.width = 2;
  EXPECT_DEATH(encode(message), "check failed");
}

// The paper's ratio: a colour SVGA image is about 15,000 times the size of a position.
TEST(Codec, APositionTakesAtMost96Bytes) {
  Header header;
  header.src = 1234;
  header.dst = 5678;
  header.seq = 1'000'000;
  header.time = unix_time(1'763'683'200'123'456'789);
  header.mode = 12;
  header.coord = 3;
  header.width = header.height = 1;
  auto size = [&](Encoding encoding, Scalar scalar, auto... numbers) {
    header.info = {MatrixType::Position, 3, scalar, encoding};
    Draft draft = Draft::make(header);
    std::array values = {numbers...};
    std::memcpy(draft.elements().data(), values.data(), sizeof values);
    return encode(std::move(draft).finish()).size();
  };
  EXPECT_LE(size(Encoding::Text, Scalar::F64, -12.3456, 0.0512, 101.25), 96U);  // to 0.1 mm
  EXPECT_LE(size(Encoding::Text, Scalar::F32, -12.345678F, 0.05123457F, 1.2512346F), 96U);
  EXPECT_LE(size(Encoding::Binary, Scalar::F64, -12.345678901234567, 0.1 / 3, 1e-300), 96U);
}

}  // namespace
}  // namespace hc
