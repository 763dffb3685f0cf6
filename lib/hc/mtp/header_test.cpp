// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/header.h>

#include <gtest/gtest.h>

#include <random>

namespace hc {
namespace {

Header example() {
  Header header;
  header.src = 12;
  header.seq = 1042;
  header.time = unix_time(1763683200123456789);
  header.mode = 1;
  header.coord = 3;
  header.width = header.height = 1;
  return header;
}

TEST(Header, IsElevenIntegersInPlainText) {
  EXPECT_EQ(text(example()), "1 12 0 1042 8 1763683200123456789 10390 1 3 1 1");
  EXPECT_EQ(*parse_header(text(example())), example());
  EXPECT_EQ(example().element_bytes(), 24U);
}

TEST(Header, ComesBackFromItsLine) {
  std::mt19937_64 random(1);
  auto up_to = [&](std::int64_t most) {
    // All lengths are equally likely.
    auto bits = static_cast<unsigned>(random() % 64);
    auto value = static_cast<std::int64_t>(random() >> bits >> 1);
    return value % most + (random() % 16 == 0 ? 1 : 0);
  };
  constexpr std::int64_t kMost = 2147483647;
  for (int i = 0; i < 1'000'000; ++i) {
    Header header;
    header.src = static_cast<std::int32_t>(up_to(kMost));
    header.dst = static_cast<std::int32_t>(random());
    header.seq = up_to(INT64_MAX);
    header.ttl = static_cast<std::uint8_t>(random());
    header.time = unix_time(up_to(INT64_MAX));
    header.mode = static_cast<std::int32_t>(up_to(kMost));
    header.coord = static_cast<std::int32_t>(up_to(kMost));
    header.width = static_cast<std::int32_t>(up_to(4000));
    header.height = static_cast<std::int32_t>(up_to(2000));
    auto again = parse_header(text(header));
    ASSERT_TRUE(again) << again.error().detail;
    ASSERT_EQ(*again, header) << text(header);
  }
}

TEST(Header, R5_LooseSpellingsMeanTheSame) {
  EXPECT_EQ(*parse_header("  1 12  0 1042 8 1763683200123456789 10390 1 3 1 1  "), example());
  std::string line = text(example());
  for (std::size_t length = line.size(); length <= 255; ++length) {
    EXPECT_EQ(*parse_header(line), example()) << length;
    line += ' ';
  }
}

TEST(Header, EveryCanonicalLengthTakesTheSameWay) {
  // The fast path branches at 64 and 128 bytes.
  for (int digits = 1; digits <= 18; ++digits) {
    std::string number(static_cast<std::size_t>(digits), '7');
    for (const char* dst : {"0", "-2147483648", "2147483647"}) {
      std::string line = "1 2147483647 " + std::string(dst) + " " + number + " 255 " + number +
                         " 120100 2147483647 2147483647 3 4";
      auto header = parse_header(line);
      ASSERT_TRUE(header) << header.error().detail;
      EXPECT_EQ(text(*header), line);
    }
  }
}

TEST(Header, R5_NonDigitsAreFoundWhereverTheyStand) {
  std::string line = text(example());
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ' ') continue;
    for (char c : {'x', '\0', '\t', '/', ':', '\xb0', '.'}) {
      std::string broken = line;
      broken[i] = c;
      auto header = parse_header(broken);
      ASSERT_FALSE(header) << broken;
      EXPECT_TRUE(header.error().detail.starts_with("R5 ")) << header.error().detail;
    }
  }
}

TEST(Header, ErrorsNameRuleFieldAndByte) {
  auto detail = [](std::string_view line) { return parse_header(line, {}, 100).error().detail; };
  EXPECT_EQ(detail("1 -1 0 0 8 0 10390 1 3 1 1"), "R7 src: -1 is below 0, at byte 102");
  EXPECT_EQ(detail("1 7 0 0 256 0 10390 1 3 1 1"), "R10 ttl: 256 is above 255, at byte 108");
  EXPECT_EQ(parse_header("2 0").error().code, Code::Unsupported);
  EXPECT_EQ(parse_header("1 7 0 0 8 0 30301 1 7 2147483647 2147483647").error().code,
            Code::TooLarge);
}

TEST(Header, TheLimitIsTheReadersOwn) {
  EXPECT_TRUE(parse_header("1 7 0 0 8 0 40101 1 7 10 10", Limits{100}));
  EXPECT_FALSE(parse_header("1 7 0 0 8 0 40101 1 7 10 10", Limits{99}));
}

TEST(Header, CheckFindsWhatReadersWouldRefuse) {
  EXPECT_TRUE(check(example()));
  Header header = example();
  header.width = -1;
  EXPECT_EQ(check(header).error().detail, "R15 width: -1 is below 0");
  header = example();
  header.info.components = 4;
  EXPECT_EQ(check(header).error().detail, "R18 info: position has 3, 6 or 9 components, not 4");
  header = example();
  header.info.type = MatrixType::DenseGraph;
  header.height = 2;
  EXPECT_TRUE(check(header).error().detail.starts_with("R23 height"));
  header = example();
  header.width = header.height = 2147483647;
  EXPECT_TRUE(check(header).error().detail.starts_with("R24 width"));
}

TEST(Header, APositionMessageStaysWithin96Bytes) {
  Header header = example();
  header.src = header.dst = 2147483647;
  EXPECT_LE(text(header).size() + 1 + std::string("0.123456 -0.051234 1.253456\n").size(), 96U);
}

}  // namespace
}  // namespace hc
