// SPDX-License-Identifier: Apache-2.0
#include <hc/module/kind.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Kind, SmallThingsAreTextLargeOnesBinary) {
  EXPECT_EQ(position<double>().type.info.code(), 10390);
  EXPECT_EQ(rotation<float>(6).type.info.code(), 20680);
  EXPECT_EQ(rgb_image<std::uint8_t>().type.info.code(), 30301);
  EXPECT_EQ(intensity_image<float>().type.info.code(), 40181);
  EXPECT_EQ(vector_field<float>(2).type.info.code(), 50281);
  EXPECT_EQ(string().type.info.code(), 60100);
  EXPECT_EQ(transformation<double>(4, 3).type.info.code(), 70190);
  EXPECT_EQ(sound<std::int16_t>(2).type.info.code(), 100231);
  EXPECT_EQ(table<double>().type.info.code(), 120190);
}

TEST(Kind, MessagesAreMadeInOneLine) {
  auto point = position(1.0, 2.0, 3.0);
  EXPECT_EQ(point.matrix().at(0, 0, 2), 3.0);
  EXPECT_EQ(string("hello").characters(), "hello");
  auto scores = table({1, 2});
  EXPECT_EQ(scores.matrix().at(0, 1), 2);
  EXPECT_EQ(scores.header.width, 2);
}

TEST(Fits, NamesTheRuleOfTheFieldThatDoesNot) {
  auto type = transformation<double>(4, 3).in(7004).type;
  Header header;
  header.info = type.info;
  header.width = 4;
  header.height = 3;
  EXPECT_TRUE(fits(header, type));
  auto detail = [&](auto change) {
    Header changed = header;
    change(changed);
    return fits(changed, type).error().detail;
  };
  EXPECT_EQ(detail([](Header& h) { h.info.type = MatrixType::Table; }),
            "R17 info: table does not fit, the port takes transformation");
  EXPECT_TRUE(detail([](Header& h) { h.info.components = 2; }).starts_with("R18 info"));
  EXPECT_TRUE(detail([](Header& h) { h.info.scalar = Scalar::F32; }).starts_with("R19 info"));
  EXPECT_TRUE(detail([](Header& h) { h.width = 3; }).starts_with("R15 width"));
  EXPECT_TRUE(detail([](Header& h) { h.height = 4; }).starts_with("R16 height"));
  EXPECT_TRUE(detail([](Header& h) { h.coord = 3; }).starts_with("R44 coord"));
}

}  // namespace
}  // namespace hc
