// SPDX-License-Identifier: Apache-2.0
#include <hc/wire/header_memo.h>

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace hc {
namespace {

using internal::HeaderMemo;

/// A header of a stream, in which most but seq and time is mostly as it was.
class Stream {
 public:
  Header next() {
    ++header_.seq;
    header_.time += 33'000'000;
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
        header_.seq = std::numeric_limits<std::int64_t>::max() - 1;
        break;
      case 4:
        header_.time = 0;
        break;
      case 5:
        header_.time = 999'999'999;
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
    header.time = 1'763'683'200'123'456'789;
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
  const Limits limits{30'000};  // that some of the headers break
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

TEST(HeaderMemo, ALowerLimitHoldsAtOnce) {
  HeaderMemo memo;
  std::string line = text(Stream().next());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(memo.parse(line, {1600}, 0));
  EXPECT_EQ(memo.parse(line, {1599}, 0).error().code, Code::TooLarge);
}

}  // namespace
}  // namespace hc
