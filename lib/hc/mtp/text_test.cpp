// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/text.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <vector>

namespace hc {
namespace {

Header table_header(std::int32_t width, std::int32_t height, Scalar scalar) {
  Header header;
  header.info = {MatrixType::Table, 1, scalar, Encoding::Text};
  header.width = width;
  header.height = height;
  return header;
}

template <typename T>
std::string written(T value) {
  std::string text;
  append_text(table_header(1, 1, scalar_for<T>()), std::as_bytes(std::span(&value, 1)), text);
  text.pop_back();  // the line feed
  return text;
}

template <typename T>
Result<T> parse_number(std::string_view token) {
  T value{};
  auto parsed = parse_number(token, scalar_for<T>(), reinterpret_cast<std::byte*>(&value));
  if (!parsed) return parsed.error();
  return value;
}

TEST(Number, R39_IsShortest) {
  EXPECT_EQ(written(0.1), "0.1");
  EXPECT_EQ(written(1e5), "1e+05");
  EXPECT_EQ(written(12345.0), "12345");
  EXPECT_EQ(written(-0.0), "-0");
  EXPECT_EQ(written(std::nan("")), "nan");
  EXPECT_EQ(written(-std::nan("")), "nan");
  EXPECT_EQ(written(-INFINITY), "-inf");
  EXPECT_EQ(written(0.1F), "0.1");
  EXPECT_EQ(written(5e-324), "5e-324");
  EXPECT_EQ(written(std::int8_t{-128}), "-128");
  EXPECT_EQ(written(UINT64_MAX), "18446744073709551615");
  EXPECT_EQ(written(INT64_MIN), "-9223372036854775808");
}

TEST(Number, ComesBackToTheBit) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 300'000; ++i) {
    auto bits = random();
    auto wide = std::bit_cast<double>(bits);
    auto narrow = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (!std::isnan(wide)) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(*parse_number<double>(written(wide))), bits);
    }
    if (!std::isnan(narrow)) {
      auto low = static_cast<std::uint32_t>(bits);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(*parse_number<float>(written(narrow))), low);
    }
    auto shifted = bits >> (bits % 64);
    ASSERT_EQ(*parse_number<std::uint64_t>(written(shifted)), shifted);
    auto negative = -static_cast<std::int64_t>(shifted >> 1);
    ASSERT_EQ(*parse_number<std::int64_t>(written(negative)), negative);
  }
}

TEST(Number, R27_R28_RefusesWhatIsNone) {
  EXPECT_TRUE(parse_number<double>("").error().detail.starts_with("R27"));
  EXPECT_TRUE(parse_number<double>("1 ").error().detail.starts_with("R27"));
  EXPECT_TRUE(parse_number<double>("+1").error().detail.starts_with("R27"));
  EXPECT_TRUE(parse_number<double>("nan(1)").error().detail.starts_with("R27"));
  EXPECT_TRUE(parse_number<double>(std::string(65, '1')).error().detail.starts_with("R31"));
  EXPECT_TRUE(parse_number<std::uint8_t>("256").error().detail.starts_with("R28"));
  EXPECT_TRUE(parse_number<std::int8_t>("-129").error().detail.starts_with("R28"));
  EXPECT_TRUE(parse_number<float>("1e39").error().detail.starts_with("R28"));
  EXPECT_TRUE(parse_number<double>("0.001e400").error().detail.starts_with("R28"));
}

TEST(Number, R28_TooSmallIsZero) {
  EXPECT_EQ(*parse_number<double>("1e-400"), 0.0);
  EXPECT_TRUE(std::signbit(*parse_number<double>("-1000.0e-400")));
  EXPECT_EQ(*parse_number<float>("0.0000001e-40"), 0.0F);
}

TEST(TextRows, ReadInPiecesOfAnySizeAreTheSame) {
  const std::string text = "  1 -2.5 3e2\r\nnan 4   0.125 \n-inf 0 1\n";
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    TextRows rows(table_header(3, 3, Scalar::F64));
    double numbers[9];
    std::size_t at = 0;
    for (std::size_t end = piece; !rows.done(); end = std::min(end + piece, text.size())) {
      auto used = rows.read(std::string_view(text).substr(at, end - at), at,
                            reinterpret_cast<std::byte*>(numbers + rows.count()));
      ASSERT_TRUE(used) << piece << ": " << used.error().detail;
      at += *used;
    }
    EXPECT_EQ(at, text.size());
    EXPECT_EQ(numbers[1], -2.5);
    EXPECT_EQ(numbers[2], 300);
    EXPECT_TRUE(std::isnan(numbers[3]));
    EXPECT_EQ(numbers[6], -INFINITY);
    EXPECT_EQ(numbers[8], 1);
  }
}

TEST(TextRows, R31_AnOpenNumberIsBounded) {
  TextRows rows(table_header(1, 1, Scalar::F64));
  double number;
  auto* at = reinterpret_cast<std::byte*>(&number);
  EXPECT_EQ(*rows.read(std::string(64, '1'), 0, at), 0U);
  EXPECT_TRUE(rows.read(std::string(65, '1'), 0, at).error().detail.starts_with("R31"));
}

TEST(AppendText, WritesRows) {
  std::vector<float> numbers(3000);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i) / 7;
  Header header = table_header(1000, 3, Scalar::F32);
  std::string text;
  append_text(header, std::as_bytes(std::span(numbers)), text);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  std::vector<float> again(3000);
  TextRows rows(header);
  EXPECT_EQ(*rows.read(text, 0, reinterpret_cast<std::byte*>(again.data())), text.size());
  EXPECT_EQ(again, numbers);
}

/// Reads one text number as TextRows does.
template <typename T>
T read_one(const std::string& number) {
  Header header;
  header.info = {MatrixType::Table, 1, scalar_for<T>(), Encoding::Text};
  header.width = header.height = 1;
  T value{};
  EXPECT_TRUE(TextRows(header).read(number + "\n", 0, reinterpret_cast<std::byte*>(&value)));
  return value;
}

template <typename T>
void expect_correct_rounding(const std::string& number) {
  T expected{};
  std::from_chars(number.data(), number.data() + number.size(), expected);
  EXPECT_EQ(std::signbit(read_one<T>(number)), std::signbit(expected)) << number;
  EXPECT_EQ(read_one<T>(number), expected) << number;
}

TEST(Text, R27_FloatsAreRoundedToTheNearest) {
  for (const char* middle :
       {"9007199254740993", "9007199254740993.0", "9007199254740993.1", "9007199254740992.9",
        "-9007199254740995", "16777217", "16777217.01", "0.5", "-0", "-0.000", "0.1",
        "99999999999999999.9", "999999999999999999", "1000000000000000000", "0.000000000000000001",
        "4503599627370497.5", "2251799813685249.25", "1125899906842624.125", "8388609.5"}) {
    expect_correct_rounding<double>(middle);
    expect_correct_rounding<float>(middle);
  }
  std::mt19937_64 random(9);
  for (int i = 0; i < 300'000; ++i) {
    std::string number = std::to_string(random() >> (random() % 64));
    number.insert(random() % (number.size() + 1), 1, '.');
    if (number == ".") continue;
    if (random() % 2 == 0) number.insert(0, 1, '-');
    expect_correct_rounding<double>(number);
    expect_correct_rounding<float>(number);
  }
}

TEST(Text, R27_TheMiddleOfTwoFloatsIsDistinguishedFromItsNeighbours) {
  std::mt19937_64 random(10);
  for (int i = 0; i < 100'000; ++i) {
    // Odd numbers of 54 bits are halfway between two f64, those of 25 bits between two f32.
    std::uint64_t middle = (random() >> 11) | (std::uint64_t{1} << 53) | 1;
    expect_correct_rounding<double>(std::to_string(middle));
    expect_correct_rounding<double>(std::to_string(middle) + ".1");
    std::uint64_t small = (random() >> 40) | (std::uint64_t{1} << 24) | 1;
    expect_correct_rounding<float>(std::to_string(small));
    expect_correct_rounding<float>(std::to_string(small - 1) + ".9999999");
  }
}

}  // namespace
}  // namespace hc
