// SPDX-License-Identifier: Apache-2.0
#include "gateway.h"

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>
#include <hc/compress/compress.h>

namespace {

hc::Message message(const hc::Info& info, std::int32_t width, std::int32_t height) {
  hc::Draft draft = hc::Draft::make(info, height, width);
  std::memset(draft.elements().data(), 7, draft.elements().size());
  return std::move(draft).finish();
}

const hc::Info kImage{hc::MatrixType::RgbImage, 3, hc::Scalar::U8, hc::Encoding::Binary};
const hc::Info kMap{hc::MatrixType::Map, 1, hc::Scalar::F32, hc::Encoding::Binary};

TEST(Gateway, reads_its_tables) {
  auto numbers = parse_renumbering("  12=112 13=12  -2=-5 ");
  ASSERT_TRUE(numbers.has_value());
  EXPECT_EQ(*numbers, (Renumbering{{12, 112}, {13, 12}, {-2, -5}}));
  EXPECT_TRUE(parse_renumbering("")->empty());
  for (const char* bad : {"12", "12=", "=12", "a=1", "1=2x", "1=2 1=3", "1=2 3=2", "0=1", "1=0",
                          "-1=-2", "1=-2", "-2=1", "1=99999999999"})
    EXPECT_EQ(parse_renumbering(bad).error().code, hc::Code::Invalid) << bad;
  EXPECT_EQ(*parse_addresses("12 -1 0"), (std::set<std::int32_t>{-1, 0, 12}));
  for (const char* bad : {"x", "1 1", "1,2"})
    EXPECT_EQ(parse_addresses(bad).error().code, hc::Code::Invalid) << bad;
}

TEST(Gateway, gives_src_and_dst_their_numbers_of_the_other_side) {
  GatewayRules rules{*parse_renumbering("12=112 11=12"), {}, {}};
  GatewayCounts counts;
  hc::Header header;
  header.src = 11;
  header.dst = 12;
  ASSERT_TRUE(admit(header, rules, counts));
  EXPECT_EQ(header.src, 12);
  EXPECT_EQ(header.dst, 112);
  EXPECT_EQ(header.ttl, 7);
  header.dst = -1;
  ASSERT_TRUE(admit(header, rules, counts));
  EXPECT_EQ(header.src, 112);
  EXPECT_EQ(header.dst, -1);
}

TEST(Gateway, drops_what_is_not_listed_and_what_R42_ends) {
  GatewayRules rules{{}, *parse_addresses("12 -1"), *parse_addresses("11")};
  GatewayCounts counts;
  hc::Header header;
  header.src = 11;
  header.dst = 12;
  header.ttl = 2;
  EXPECT_TRUE(admit(header, rules, counts));
  EXPECT_FALSE(admit(header, rules, counts));
  header.ttl = 8;
  header.dst = 13;
  EXPECT_FALSE(admit(header, rules, counts));
  header.dst = 12;
  header.src = 12;
  EXPECT_FALSE(admit(header, rules, counts));
  EXPECT_EQ(counts.text(), "0 passed; dropped: 1 ttl, 2 not listed, 0 without a route, 0 damaged");
}

TEST(Gateway, R21_compresses_what_can_be_and_leaves_the_rest) {
  auto image = message(kImage, 64, 48), map = message(kMap, 64, 48);
  auto jpeg = in_encoding(image, hc::Encoding::Jpeg);
  ASSERT_TRUE(jpeg.has_value());
  EXPECT_EQ(jpeg->header.info.encoding, hc::Encoding::Jpeg);
  EXPECT_LT(jpeg->elements.size(), image.elements.size());
  EXPECT_EQ(in_encoding(map, hc::Encoding::Jpeg)->header, map.header);
  auto zstd = in_encoding(map, hc::Encoding::Zstd);
  EXPECT_EQ(zstd->header.info.encoding, hc::Encoding::Zstd);
  // Messages already compressed, or that would grow, are passed on unchanged.
  EXPECT_EQ(in_encoding(*jpeg, hc::Encoding::Zstd)->elements.data(), jpeg->elements.data());
  EXPECT_EQ(in_encoding(message(kMap, 1, 1), hc::Encoding::Zstd)->header.info, kMap);
  EXPECT_EQ(in_encoding(message(kMap, 0, 0), hc::Encoding::Zstd)->header.info, kMap);
  auto plain = in_encoding(*zstd, hc::Encoding::Text);
  EXPECT_EQ(plain->header.info.encoding, hc::Encoding::Text);
  EXPECT_TRUE(std::equal(plain->elements.begin(), plain->elements.end(), map.elements.begin(),
                         map.elements.end()));
}

TEST(Gateway, elements_that_cannot_be_opened_are_an_error) {
  auto damaged = *hc::compress(message(kMap, 64, 48), hc::Encoding::Zstd);
  damaged.elements = damaged.elements.first(damaged.elements.size() / 2);
  EXPECT_EQ(in_encoding(damaged, hc::Encoding::Binary).error().code, hc::Code::Malformed);
}

}  // namespace
