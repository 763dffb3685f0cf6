// SPDX-License-Identifier: Apache-2.0
#include <hc/module/kind.h>

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace hc {
namespace {

TEST(Kind, SmallThingsAreTextLargeOnesBinary) {
  EXPECT_EQ(position<double>().type.info.code(), 10390);
  EXPECT_EQ(rotation<float>(6).type.info.code(), 20680);
  EXPECT_EQ(rgb_image().type.info.code(), 30301);
  EXPECT_EQ(intensity_image<float>().type.info.code(), 40181);
  EXPECT_EQ(vector_field<float>(2).type.info.code(), 50281);
  EXPECT_EQ(string().type.info.code(), 60100);
  EXPECT_EQ(transformation<double>(4, 3).type.info.code(), 70190);
  EXPECT_EQ(sound(2).type.info.code(), 100231);
  EXPECT_EQ(table<double>().type.info.code(), 120190);
}

TEST(Kind, HasAFixedShapeWhereOneIsGiven) {
  const auto type = rotation<double>().of(1, 1).in(Coord::kGaze).finite().type;
  EXPECT_EQ(type.width, 1);
  EXPECT_EQ(type.height, 1);
  EXPECT_EQ(type.coord, 13);
  EXPECT_TRUE(type.finite);
  Header header;
  header.info = type.info;
  header.width = 2;
  header.height = 1;
  EXPECT_FALSE(fits(header, type));
  header.width = 1;
  EXPECT_TRUE(fits(header, type));
}

TEST(Kind, MakesMessagesInTheShapeOfTheirNumbers) {
  const std::uint8_t pixels[] = {1, 2, 3, 4, 5, 6};
  const double numbers[] = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(position().message({1, 2, 3}).matrix().at(0, 0, 2), 3.0);
  EXPECT_EQ(position().message(numbers).matrix().at(0, 1, 2), 6.0);
  EXPECT_EQ(rgb_image().message(2, 1, pixels).matrix().at(1, 0, 2), 6);
  EXPECT_EQ(intensity_image().message(2, 3, pixels).matrix().at(1, 0), 4);
  EXPECT_EQ(vector_field<double>(2).message(3, 1, numbers).matrix().at(2, 0, 1), 6.0);
  EXPECT_EQ(string().message("hello").text(), "hello");
  EXPECT_EQ(transformation(2, 3).message(numbers).matrix().at(1, 2), 6.0);
  EXPECT_EQ(dense_graph().message({1, 2, 3, 4}).matrix().at(1, 0), 3.0);
  const auto edges = sparse_graph().message(numbers);
  EXPECT_EQ(edges.header.width, 1);
  EXPECT_EQ(edges.matrix().at(1, 0, 2), 6.0);
  EXPECT_EQ(sound<double>(2).message(numbers).matrix().at(0, 2, 1), 6.0);
  EXPECT_EQ(map().message(3, 2, numbers).matrix().at(2, 1), 6.0);
  const auto scores = table<int>().in(40).message({1, 2});
  EXPECT_EQ(scores.matrix().at(0, 1), 2);
  EXPECT_EQ(scores.header.width, 2);
  EXPECT_EQ(scores.header.coord, 40);
  EXPECT_EQ(table().of(0, 3).message(numbers).header.height, 2);
  EXPECT_EQ(table().of(3, 0).message(numbers).header.width, 2);
  EXPECT_EQ(table().message({}).header.width, 0);
  for (const auto& each : {Message(edges), Message(sound<double>(2).message(numbers))})
    EXPECT_TRUE(check(each.header, {}));
}

TEST(Kind, NumbersThatDoNotFillTheShapeAreABug) {
  EXPECT_DEATH(static_cast<void>(table().of(1, 2).message({1, 2, 3})), "check failed");
  EXPECT_DEATH(static_cast<void>(position().message({1, 2})), "check failed");
  EXPECT_DEATH(static_cast<void>(dense_graph().message({1, 2, 3})), "check failed");
}

TEST(Kind, AnElementThatIsNotThereIsNotRead) {
  const auto none = position().message({});
  EXPECT_THROW(static_cast<void>(none.numbers()[0]), std::out_of_range);
  EXPECT_THROW(static_cast<void>(none.numbers().front()), std::out_of_range);
  EXPECT_THROW(static_cast<void>(none.numbers().back()), std::out_of_range);
  EXPECT_THROW(static_cast<void>(none.matrix().at(0, 0)), std::out_of_range);
  EXPECT_THROW(static_cast<void>(none.matrix().row(0)), std::out_of_range);
  const auto one = position().message({1, 2, 3});
  EXPECT_THROW(static_cast<void>(one.numbers()[3]), std::out_of_range);
  EXPECT_THROW(static_cast<void>(one.matrix().at(0, 0, 3)), std::out_of_range);
  EXPECT_THROW(static_cast<void>(one.matrix().at(0, 1)), std::out_of_range);
  EXPECT_THROW(static_cast<void>(one.numbers().first(4)), std::out_of_range);
  EXPECT_THROW(static_cast<void>(one.numbers().subspan(4)), std::out_of_range);
  EXPECT_TRUE(one.numbers().subspan(3).empty());
  EXPECT_EQ(one.numbers().subspan(1).front(), 2);
}

TEST(Kind, AnyImageIsInColourOrGrey) {
  const AnyKind kind = image(7);
  ASSERT_EQ(kind.types.size(), 2U);
  EXPECT_EQ(in_words(kind.types), in_words({rgb_image().in(7).type,
                                            intensity_image().in(7).type}));
  EXPECT_EQ(image().types[0].coord, 0);
}

TEST(Finite, NeitherNaNNorInfinity) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(finite(position().message({1, 2, 3}).numbers()));
  EXPECT_FALSE(finite(position().message({1, kNan, 3}).numbers()));
  EXPECT_FALSE(finite(position<float>().message({1, 2, std::numeric_limits<float>::infinity()})));
  EXPECT_TRUE(finite(Message(string().message("nan"))));
}

TEST(Fits, NamesTheRuleOfTheFieldThatDoesNot) {
  auto type = transformation(3, 4).in(7004).type;
  Header header;
  header.info = type.info;
  header.width = 4;
  header.height = 3;
  EXPECT_TRUE(fits(header, type));
  auto detail = [&](auto change) {
    Header changed = header;
    change(changed);
    EXPECT_FALSE(fits(changed, type));
    return misfit(changed, type).detail;
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
