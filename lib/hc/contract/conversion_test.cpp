// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/conversion.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

Result<Conversion> taken(const std::string& options) {
  auto uri = *parse_uri("tcp:h:1?keep=latest&" + options);
  auto conversion = take_conversion(uri);
  if (conversion) {
    EXPECT_EQ(uri.text(), "tcp:h:1?keep=latest");
  }
  return conversion;
}

TEST(Conversion, IsTakenOutOfAUri) {
  const auto conversion = taken("as=jpeg&quality=60&scale=0.5");
  ASSERT_TRUE(conversion) << conversion.error().detail;
  EXPECT_EQ(conversion->as, Encoding::Jpeg);
  EXPECT_EQ(conversion->quality, 60);
  EXPECT_EQ(conversion->scale, 0.5);
  EXPECT_FALSE(conversion->is_none());
  Uri none;
  EXPECT_TRUE(take_conversion(none)->is_none());
}

TEST(Conversion, ALinkMaySlowDownAndBelongToOthers) {
  const auto conversion = taken("idle_rate=0.5&pair=view.left");
  ASSERT_TRUE(conversion) << conversion.error().detail;
  EXPECT_EQ(conversion->idle_rate, 0.5);
  EXPECT_EQ(conversion->pair, "view.left");
  EXPECT_TRUE(conversion->is_none());
  for (const char* rate : {"0", "-1", "1001", "inf", "x"})
    EXPECT_EQ(taken("idle_rate=" + std::string(rate)).error().detail,
              "option idle_rate is a number from 0.01 to 1000");
}

TEST(Conversion, IsRefused) {
  for (const char* scale :
       {"scale=0", "scale=1.01", "scale=-1", "scale=nan", "scale=1e-3", "scale=x"})
    EXPECT_EQ(taken(scale).error().detail, "option scale is a number from 0.01 to 1") << scale;
  EXPECT_EQ(taken("as=png").error().detail, "option as is text, binary, zstd or jpeg");
  for (const char* quality : {"0", "101", "1.5", "-1"})
    EXPECT_EQ(taken("as=jpeg&quality=" + std::string(quality)).error().detail,
              "option quality is a whole number from 1 to 100");
  EXPECT_EQ(taken("as=zstd&quality=50").error().detail, "option quality needs as=jpeg");
}

TEST(Conversion, IsHindered) {
  const PortType image{{MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}};
  const PortType depth{{MatrixType::IntensityImage, 1, Scalar::F32, Encoding::Binary}};
  PortType fixed = image;
  fixed.width = 640;
  Conversion half;
  half.scale = 0.5;
  Conversion jpeg;
  jpeg.as = Encoding::Jpeg;
  EXPECT_EQ(hindrance(half, {image}, {image}), "");
  EXPECT_EQ(hindrance(half, {}, {fixed}), "");
  EXPECT_EQ(hindrance(half, {depth}, {}),
            "scale is for images of u8 or u16, not intensity_image of 1 x f32");
  EXPECT_NE(hindrance(half, {image}, {fixed}), "");
  EXPECT_EQ(hindrance(half, {image}, {fixed, image}), "");
  EXPECT_EQ(hindrance(jpeg, {image}, {fixed}), "");
  EXPECT_TRUE(hindrance(jpeg, {depth}, {}).starts_with("as: R21 "));
}

TEST(Conversion, LeavesAPixelAtLeast) {
  EXPECT_EQ(scaled(640, 0.5), 320);
  EXPECT_EQ(scaled(3, 0.5), 2);
  EXPECT_EQ(scaled(1, 0.01), 1);
  EXPECT_EQ(scaled(0, 0.5), 0);
}

}  // namespace
}  // namespace hc
