// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/header_memo.h>

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace hc {
namespace {

using internal::HeaderMemo;

/// Headers of a stream, in which fields other than seq and time rarely change.
class Stream {
 public:
  Header next() {
    constexpr auto kLast = std::numeric_limits<std::int64_t>::max();
    header_.seq = header_.seq == kLast ? 0 : header_.seq + 1;
    header_.time += std::chrono::milliseconds(33);
    switch (below(60)) {
      case 0:
        header_.src = below(3) * 1000;
        break;
      case 1:
        header_.width = below(2000);
        break;
      case 2:
        header_.seq = 0;
        break;
      case 3:
        header_.seq = kLast - 1;
        break;
      case 4:
        header_.time = {};
        break;
      case 5:
        header_.time = unix_time(999'999'999);
        break;
      case 6:
        header_.dst = below(3) - 1;
        break;
      default:
        break;
    }
    return header_;
  }
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }

 private:
  Header header_ = [] {
    Header header;
    header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
    header.width = header.height = 40;
    header.time = unix_time(1'763'683'200'123'456'789);
    return header;
  }();
  std::mt19937 random_{1};
};

TEST(HeaderMemo, FormatsAsAlways) {
  Stream stream;
  HeaderMemo memo;
  for (int i = 0; i < 200'000; ++i) {
    Header header = stream.next();
    char ours[kMaxHeaderBytes], wanted[kMaxHeaderBytes];
    std::string_view line(ours, memo.format(header, ours));
    ASSERT_EQ(line, std::string_view(wanted, format_header(header, wanted)));
  }
}

TEST(HeaderMemo, ParsesAsAlways) {
  Stream stream;
  HeaderMemo memo;
  const Limits limits{30'000};  // some of the headers exceed it
  for (int i = 0; i < 200'000; ++i) {
    std::string line = text(stream.next());
    if (stream.below(4) == 0)
      line[static_cast<std::size_t>(stream.below(static_cast<int>(line.size())))] =
          static_cast<char>("0123456789 -x"[stream.below(13)]);
    if (stream.below(50) == 0) line.insert(line.find(' '), " ");
    auto ours = memo.parse(line, limits, 7), wanted = parse_header(line, limits, 7);
    ASSERT_EQ(ours.has_value(), wanted.has_value()) << line;
    if (wanted)
      ASSERT_EQ(*ours, *wanted) << line;
    else
      ASSERT_EQ(ours.error().text(), wanted.error().text()) << line;
  }
}

/// The smallest and the largest number with this many digits, and one between them.
std::vector<std::int64_t> numbers_of(int digits) {
  std::int64_t least = 1;
  for (int i = 1; i < digits; ++i) least *= 10;
  const auto most =
      digits == 19 ? std::numeric_limits<std::int64_t>::max() : least + (least - 1) + 8 * least;
  return {digits == 1 ? 0 : least, least + (most - least) / 7 * 3, most};
}

/// seq and time of all lengths, and hence at all offsets within a word.
TEST(HeaderMemo, NumbersOfEveryLengthAreAsAlways) {
  HeaderMemo writing, reading;
  Header header = Stream().next();
  for (std::int32_t src : {0, 10, 200, 3000, 40'000, 500'000, 6'000'000, 70'000'000})
    for (int seq_digits = 1; seq_digits <= 19; ++seq_digits)
      for (int time_digits = 1; time_digits <= 19; ++time_digits)
        for (int i = 0; i < 12; ++i) {  // the memo takes effect after a few
          header.src = src;
          header.seq = numbers_of(seq_digits)[static_cast<std::size_t>(i) % 3];
          header.time = unix_time(numbers_of(time_digits)[static_cast<std::size_t>(i) / 3 % 3]);
          char line[kMaxHeaderBytes];
          std::string_view ours(line, writing.format(header, line));
          ASSERT_EQ(ours, text(header) + "\n");
          // In a buffer of the exact size, so that ASan detects reads beyond the line.
          std::vector<char> exact(ours.begin(), ours.end() - 1);
          auto parsed = reading.parse({exact.data(), exact.size()}, {}, 0);
          ASSERT_TRUE(parsed) << parsed.error().text();
          ASSERT_EQ(*parsed, header);
        }
}

/// Two headers of equal length and one of another, in runs of all lengths.
TEST(HeaderMemo, GoesBackAndForthBetweenHeaders) {
  std::array<Header, 3> headers;
  for (auto& header : headers) header = Stream().next();
  headers[1].src = 1;
  headers[2].width = 400;
  for (int row = 1; row <= 20; ++row) {
    HeaderMemo writing, reading;
    for (int i = 0; i < 40 * row; ++i) {
      Header& header = headers[static_cast<std::size_t>(i / row) % 3];
      ++header.seq;
      header.time += std::chrono::nanoseconds(1'000'000'007);
      char line[kMaxHeaderBytes];
      std::string_view ours(line, writing.format(header, line));
      ASSERT_EQ(ours, text(header) + "\n");
      ASSERT_EQ(*reading.parse(ours.substr(0, ours.size() - 1), {}, 0), header);
    }
  }
}

/// The longest canonical line, and the longest line allowed.
TEST(HeaderMemo, LongLinesAreAsAlways) {
  constexpr auto kMost = std::numeric_limits<std::int32_t>::max();
  Header header;
  header.src = header.mode = header.coord = kMost;
  header.dst = std::numeric_limits<std::int32_t>::min();
  header.ttl = 255;
  header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
  header.width = kMost;
  header.height = 1;
  const Limits limits{std::uint64_t{1} << 40};
  HeaderMemo writing, reading;
  for (int i = 0; i < 40; ++i) {
    header.seq = std::numeric_limits<std::int64_t>::max() - i;
    header.time = unix_time(header.seq);
    char line[kMaxHeaderBytes];
    std::string ours(line, writing.format(header, line) - 1);
    ASSERT_EQ(ours, text(header));
    ASSERT_EQ(*reading.parse(ours, limits, 0), header);
    if (i % 3 == 0) {
      ours.insert(ours.rfind(' '), kMaxHeaderBytes - ours.size(), ' ');
      ASSERT_EQ(*reading.parse(ours, limits, 0), header);
    }
  }
}

TEST(HeaderMemo, SpellingsThatNoWriterWritesAreNotRemembered) {
  HeaderMemo memo;
  const std::string line = text(Stream().next());
  const std::string spaced = line.substr(0, 1) + " " + line.substr(1);
  for (int i = 0; i < 40; ++i) ASSERT_EQ(*memo.parse(spaced, {}, 0), *parse_header(line));
  for (int i = 0; i < 40; ++i) ASSERT_EQ(*memo.parse(line, {}, 0), *parse_header(line));
}

/// Tokens as long as the remembered numbers, but not spelled as in R5.
TEST(HeaderMemo, DigitsAloneAreNumbers) {
  HeaderMemo memo;
  Header header = Stream().next();
  header.seq = 1'234'567'890'123'456'789;
  const std::string line = text(header);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(memo.parse(line, {}, 0));
  for (const char* number : {"0234567890123456789", "9223372036854775808", "9999999999999999999",
                             "-234567890123456789", "123456789012345678/", "1234567:90123456789"})
    for (std::int64_t field : {header.seq, unix_nanoseconds(header.time)}) {
      std::string wrong = line;
      wrong.replace(wrong.find(std::to_string(field)), std::strlen(number), number);
      auto ours = memo.parse(wrong, {}, 5), wanted = parse_header(wrong, {}, 5);
      ASSERT_FALSE(wanted) << wrong;
      ASSERT_FALSE(ours) << wrong;
      EXPECT_EQ(ours.error().text(), wanted.error().text());
    }
}

TEST(HeaderMemo, WhatIsBelow0IsWrittenAsAlways) {
  HeaderMemo memo;
  Header header = Stream().next();
  for (int i = 0; i < 40; ++i) {  // the lines are equally long
    header.seq = i < 20 ? -5 : 42;
    char line[kMaxHeaderBytes];
    ASSERT_EQ(std::string_view(line, memo.format(header, line)), text(header) + "\n");
  }
}

/// So that copying a line by words reads no uninitialised bytes.
TEST(HeaderMemo, TheLastWordOfALineIsFilledUp) {
  HeaderMemo memo;
  Header header = Stream().next();
  for (int i = 0; i < 3000; ++i) {
    header.seq = i;
    if (i % 20 == 0) header.src = i;
    std::array<char, kMaxHeaderBytes> line;
    line.fill('x');
    for (auto at = memo.format(header, line); at % sizeof(std::uint64_t) != 0; ++at)
      ASSERT_EQ(line[at], '\0') << i;
  }
}

TEST(HeaderMemo, ALowerLimitHoldsAtOnce) {
  HeaderMemo memo;
  std::string line = text(Stream().next());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(memo.parse(line, {1600}, 0));
  EXPECT_EQ(memo.parse(line, {1599}, 0).error().code, Code::TooLarge);
}

}  // namespace
}  // namespace hc
