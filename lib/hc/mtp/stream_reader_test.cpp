// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/stream_reader.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include <hc/mtp/codec.h>
#include <hc/testing/allocations.h>

namespace hc {
namespace {

/// Fills the reader's space with at most `most` bytes and removes them from the input.
void feed(StreamReader& reader, std::string_view& bytes, std::size_t most = SIZE_MAX) {
  const auto space = reader.space();
  const std::size_t size = std::min({most, space.size(), bytes.size()});
  std::memcpy(space.data(), bytes.data(), size);
  reader.commit(size);
  bytes.remove_prefix(size);
}

/// All messages of a stream that was fed in pieces, and the final error or end.
struct Reading {
  std::vector<Message> messages;
  Status end;
};

Reading read_all(std::string_view bytes, std::size_t piece, StreamReader& reader) {
  Reading reading;
  Message message;
  while (true) {
    auto got = reader.next(message);
    if (!got) {
      reading.end = got.error();
      return reading;
    }
    if (*got) {
      reading.messages.push_back(message);
      continue;
    }
    if (bytes.empty()) break;
    feed(reader, bytes, piece);
  }
  reading.end = reader.finish();
  return reading;
}

Message filled(const Info& info, std::int32_t width, std::int32_t height) {
  Draft draft = Draft::make(info, height, width);
  std::uint8_t value = 0;
  for (auto& byte : draft.elements()) byte = static_cast<std::byte>(value++ % 251);
  return std::move(draft).finish();
}

constexpr Info kPicture{MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary};
constexpr Info kTable{MatrixType::Table, 1, Scalar::I32, Encoding::Text};
constexpr Info kDepth{MatrixType::IntensityImage, 1, Scalar::F32, Encoding::Binary};

TEST(StreamReader, PiecesOfAnySizeGiveTheSameMessages) {
  std::vector<Message> sent;
  for (std::int32_t width : {1, 7, 100, 2000, 9000, 400})
    for (const Info& info : {kPicture, kTable, kDepth}) sent.push_back(filled(info, width, 3));
  std::string bytes;
  for (const auto& message : sent) bytes += encode(message);
  for (std::size_t piece : {1U, 2U, 3U, 17U, 255U, 4096U, 65536U, 10000000U}) {
    StreamReader reader;
    auto reading = read_all(bytes, piece, reader);
    EXPECT_TRUE(reading.end);
    ASSERT_EQ(reading.messages.size(), sent.size()) << piece;
    EXPECT_EQ(reader.messages(), sent.size());
    EXPECT_EQ(reader.bytes(), bytes.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
      EXPECT_EQ(reading.messages[i].header, sent[i].header);
      EXPECT_EQ(reading.messages[i].text(), sent[i].text()) << piece << " " << i;
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(reading.messages[i].elements.data()) %
                    size_of(sent[i].header.info.scalar),
                0U);
    }
  }
}

TEST(StreamReader, R2_EveryCutGivesTheMessagesBeforeIt) {
  std::string one = encode(filled(kTable, 3, 2)), two = encode(filled(kPicture, 3, 2));
  std::string bytes = one + two;
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    StreamReader reader;
    auto reading = read_all(std::string_view(bytes).substr(0, size), 5, reader);
    std::size_t whole = size == bytes.size() ? 2 : size >= one.size() ? 1 : 0;
    EXPECT_EQ(reading.messages.size(), whole);
    bool clean = size == 0 || size == one.size() || size == bytes.size();
    ASSERT_EQ(reading.end.has_value(), clean) << size;
    if (clean) continue;
    EXPECT_EQ(reading.end.error().code, Code::Truncated);
    EXPECT_EQ(reading.end.error().detail, "R2 stream: truncated in message " +
                                              std::to_string(whole + 1) + ", at byte " +
                                              std::to_string(size));
  }
}

TEST(StreamReader, AnErrorStays) {
  StreamReader reader;
  auto reading = read_all("1 7 0 0 8 0 120190 0 0 0 0\n\nrubbish\n", 100, reader);
  EXPECT_EQ(reading.messages.size(), 1U);
  ASSERT_FALSE(reading.end);
  EXPECT_EQ(reader.message_begin(), 28U);
  Message message;
  EXPECT_EQ(reader.next(message).error().detail, reading.end.error().detail);
  EXPECT_EQ(reader.finish().error().detail, reading.end.error().detail);
}

TEST(StreamReader, R40_GoesOnAtTheNextValidHeader) {
  std::string good = encode(filled(kTable, 3, 1));
  std::string bad = "1 7 0 0 8 0 40101 0 7 200 1\nshort\n" + std::string(300, 'x') + "\n2 7\n";
  std::string bytes = good + bad + good + good;
  StreamReader reader;
  auto before = read_all(bytes, 7, reader);
  ASSERT_FALSE(before.end);
  EXPECT_EQ(before.messages.size(), 1U);
  reader.resume();
  auto after = read_all(std::string_view(bytes).substr(reader.message_begin()), 7, reader);
  EXPECT_TRUE(after.end);
  EXPECT_EQ(after.messages.size(), 2U);
  EXPECT_EQ(reader.bytes(), bytes.size());
}

TEST(StreamReader, HeldMessagesKeepTheirElements) {
  StreamReader reader;
  std::string bytes;
  for (int i = 0; i < 3000; ++i) {
    Message message = filled(kDepth, 1 + i % 50, 1);
    message.header.seq = i;
    bytes += encode(message);
  }
  auto reading = read_all(bytes, 4096, reader);
  ASSERT_EQ(reading.messages.size(), 3000U);
  for (const auto& message : reading.messages)
    EXPECT_EQ(message.text(), filled(kDepth, message.header.width, 1).text());
}

TEST(StreamReader, MemoryIsUsedAgainWhenNobodyHoldsIt) {
  std::string bytes = encode(filled(kPicture, 800, 600));
  StreamReader reader;
  Message message;
  std::int64_t after_first = 0;
  for (int i = 0; i < 20; ++i) {
    std::string_view rest = bytes;
    while (!*reader.next(message)) feed(reader, rest);
    if (i == 1) after_first = allocations.bytes;
  }
  EXPECT_EQ(allocations.bytes, after_first);
}

TEST(StreamReader, ElementsOfALargeMessageAfterAnotherAreReadWhereTheyStay) {
  const Message sent = filled(kPicture, 800, 600);
  const std::string bytes = encode(sent);
  StreamReader reader;
  for (bool is_first : {true, false}) {
    std::size_t in_place = 0;
    std::string_view rest = bytes;
    Message message;
    while (!*reader.next(message)) {
      if (auto missing = reader.missing(); missing > 0) {
        const auto space = reader.space();
        EXPECT_TRUE(is_first || space.size() == missing);
        in_place += std::min(space.size(), rest.size());
      }
      feed(reader, rest);
    }
    EXPECT_EQ(message.text(), sent.text());
    EXPECT_EQ(reader.missing(), 0U);
    EXPECT_GE(in_place, sent.elements.size() - (is_first ? 65536 : 4096));
  }
}

TEST(StreamReader, R24_PromisesCostNothing) {
  std::string nines(10000, '9');
  const std::string hostile[] = {
      "1 7 0 0 8 0 40101 1 7 9223372036854775808 1\n",
      "1 7 0 0 8 0 40101 1 7 -5 1\n",
      "1 7 0 0 8 0 123290 1 40 268435456 268435456\n",
      "1 7 0 0 8 0 10390 1 3 1\n",
      "1 7 0 0 8 0 10390 1 3 1 1 1\n",
      "1 7 0 " + nines + " 8 0 10390 1 3 1 1\n",
      std::string(1 << 20, 'a'),
      std::string("1 \0 0 0 8 0 10390 1 3 1 1\n", 26),
      "1 0x7 0 0 8 0 10390 1 3 1 1\n",
      "1 7 0 0 8 0 40101 1 7 16000 16000\nabc",  // 256 MB announced, 3 bytes sent
      "1 7 0 0 8 0 40100 1 7 16000 16000\n1 2 3",
      "1 7 0 0 8 0 40102 1 7 1 1\n268435456\nabc",
  };
  for (const auto& bytes : hostile) {
    const auto before = allocations.bytes;
    {
      StreamReader reader;
      EXPECT_FALSE(read_all(bytes, SIZE_MAX, reader).end) << bytes.substr(0, 60);
    }
    EXPECT_LT(allocations.bytes - before, (1 << 20) + 100'000) << bytes.substr(0, 60);
  }
}

}  // namespace
}  // namespace hc
