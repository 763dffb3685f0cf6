// SPDX-License-Identifier: Apache-2.0
#include "encoder.h"

#include <vpx/vp8dx.h>
#include <vpx/vpx_decoder.h>

#include <vector>

#include <gtest/gtest.h>
#include <hc/module/kind.h>

namespace {

/// A message of a ramp to the right, the same in all channels.
hc::Message ramp(int width, int height) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < width * height; ++i)
    pixels.insert(pixels.end(), 3, static_cast<std::uint8_t>(i % width));
  hc::Message message = hc::rgb_image().message(height, width, pixels);
  message.header.seq = 7;
  message.header.time = hc::unix_time(5);
  message.header.coord = hc::Coord::kLeftImage;
  return message;
}

TEST(Scaled, images_shrink_by_area) {
  EXPECT_EQ(scaled(ramp(200, 100), 60)->header.height, 30);
  const auto small = scaled(ramp(200, 100), 50);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->header.width, 50);
  EXPECT_EQ(small->header.height, 25);
  EXPECT_EQ(small->header.seq, 7);
  const auto pixels = *hc::view<std::uint8_t>(*small);
  EXPECT_NEAR(pixels.at(3, 10, 1), 41.5, 0.6);  // the mean of 40 to 43
}

TEST(Scaled, other_fields_are_sampled_and_all_else_stays) {
  std::vector<float> depth(6 * 4);
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = static_cast<float>(i);
  const auto small = scaled(hc::intensity_image<float>().message(4, 6, depth), 2);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->header.width, 2);
  EXPECT_EQ(small->header.height, 2);
  EXPECT_EQ(hc::view<float>(*small)->at(1, 1), depth[3 * 6 + 3]);
  EXPECT_EQ(scaled(ramp(200, 100), 0)->header.width, 200);
  EXPECT_EQ(scaled(ramp(200, 100), 200)->header.width, 200);
  EXPECT_EQ(scaled(hc::table().message({1.0, 2.0, 3.0}), 1)->header.width, 3);
}

TEST(Vp8, frames_decode_to_what_was_encoded) {
  Vp8Encoder encoder;
  vpx_codec_ctx_t decoder;
  ASSERT_EQ(vpx_codec_dec_init(&decoder, vpx_codec_vp8_dx(), nullptr, 0), VPX_CODEC_OK);
  for (int i = 0; i < 5; ++i) {
    const auto coded = encoder.encode(ramp(201, 101), false);
    ASSERT_TRUE(coded);
    EXPECT_EQ(is_key_frame(*coded), i == 0);
    EXPECT_EQ(coded->header.info.type, hc::MatrixType::Table);
    EXPECT_EQ(coded->header.coord, hc::Coord::kLeftImage);
    EXPECT_EQ(coded->header.time, hc::unix_time(5));
    ASSERT_EQ(
        vpx_codec_decode(&decoder, reinterpret_cast<const std::uint8_t*>(coded->elements.data()),
                         static_cast<unsigned>(coded->elements.size()), nullptr, 0),
        VPX_CODEC_OK);
    vpx_codec_iter_t place = nullptr;
    const vpx_image_t* image = vpx_codec_get_frame(&decoder, &place);
    ASSERT_NE(image, nullptr);
    EXPECT_EQ(image->d_w, 200U);
    EXPECT_EQ(image->d_h, 100U);
    // Luma goes from 16 to 235.
    EXPECT_NEAR(image->planes[0][50 * image->stride[0] + 150], 16 + 150 * 219 / 255, 6);
  }
  EXPECT_TRUE(is_key_frame(*encoder.encode(ramp(201, 101), true)));
  EXPECT_TRUE(is_key_frame(*encoder.encode(ramp(64, 64), false)));  // another size
  vpx_codec_destroy(&decoder);
}

TEST(Vp8, an_image_of_one_pixel_is_an_error) {
  Vp8Encoder encoder;
  const auto coded = encoder.encode(ramp(1, 1), false);
  ASSERT_FALSE(coded);
  EXPECT_EQ(coded.error().code, hc::Code::Unsupported);
}

}  // namespace
