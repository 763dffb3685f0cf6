// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/element.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Info, IsReadByEye) {
  EXPECT_EQ(Info().code(), 10390);
  Info sound{MatrixType::Sound, 2, Scalar::I16, Encoding::Binary};
  EXPECT_EQ(sound.code(), 100231);
  EXPECT_EQ(matrix_text(sound, 800, 1), "sound 800 x 1 of 2 x i16");
  EXPECT_EQ(matrix_text(sound, 0, 1), "sound 0 x 1 of 2 x i16");
  EXPECT_EQ(matrix_text(sound, std::nullopt, 1), "sound any x 1 of 2 x i16");
  EXPECT_EQ(matrix_text(sound), "sound of 2 x i16");
  EXPECT_EQ(sound.element_bytes(), 4U);
  Info parsed;
  EXPECT_FALSE(parse_info(100231, parsed));
  EXPECT_EQ(parsed, sound);
}

TEST(Info, EveryCodeIsAcceptedOrNamesItsRule) {
  int accepted = 0;
  for (std::int64_t code = 0; code < 140000; ++code) {
    Info info;
    auto error = parse_info(code, info);
    if (!error) {
      ++accepted;
      EXPECT_EQ(info.code(), code);
      EXPECT_FALSE(find_error(info));
    } else {
      EXPECT_TRUE(error->rule >= 17 && error->rule <= 21) << error->rule << ": " << error->what;
    }
  }
  // By hand from the table: position and rotation 3·2, rgb 2·4, intensity 10, field 99·10, string
  // 1, transformation 2, dense 990, sparse 980, sound, map, table 990 each; times text, binary,
  // zstd; and two images in jpeg.
  EXPECT_EQ(accepted, 3 * (6 + 6 + 8 + 10 + 990 + 1 + 2 + 990 + 980 + 3 * 990) + 2);
}

TEST(Names, GoBothWays) {
  for (int i = 1; i <= 12; ++i) {
    auto type = static_cast<MatrixType>(i);
    EXPECT_EQ(matrix_type_of(name(type)), type);
  }
  for (int i = 0; i < 10; ++i) {
    auto scalar = static_cast<Scalar>(i);
    EXPECT_EQ(scalar_of(name(scalar)), scalar);
    visit_scalar(scalar, [&](auto zero) {
      EXPECT_EQ(scalar_for<decltype(zero)>(), scalar);
      EXPECT_EQ(size_of(scalar), sizeof zero);
    });
  }
  EXPECT_EQ(encoding_of("jpeg"), Encoding::Jpeg);
  EXPECT_FALSE(encoding_of("png"));
  EXPECT_FALSE(matrix_type_of("picture"));
}

}  // namespace
}  // namespace hc
