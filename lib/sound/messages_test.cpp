// SPDX-License-Identifier: Apache-2.0
#include <sound/messages.h>

#include <gtest/gtest.h>

#include <array>

namespace {

using hc::audio::format_of;
using hc::audio::message_of;

constexpr std::array<std::int16_t, 6> kSome = {1, 2, 3, 4, 5, 6};

TEST(SoundMessage, has_the_rate_as_its_coordinate_system) {
  const auto message = message_of(kSome, {22050, 2});
  EXPECT_EQ(message.header.coord, hc::Coord::kSound22k);
  EXPECT_EQ(message.header.width, 3);
  EXPECT_EQ(message.header.height, 1);
  EXPECT_EQ(message.matrix().at(0, 2, 1), 6);
}

TEST(SoundMessage, has_the_format_that_it_was_made_of) {
  for (const int rate : hc::audio::kRates)
    for (const int channels : {1, 2}) {
      const hc::audio::Format format{rate, channels};
      auto found = format_of(message_of(kSome, format));
      ASSERT_TRUE(found);
      EXPECT_EQ(*found, format);
    }
}

TEST(SoundMessage, of_no_sounds_coordinate_system_has_no_format) {
  auto found = format_of(hc::sound(1).in(hc::Coord::kText).message(kSome));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, hc::Code::Unsupported);
  EXPECT_EQ(found.error().detail, "coordinate system text has no sample rate");
}

TEST(SoundMessage, of_a_rate_without_a_coordinate_system_is_a_bug) {
  EXPECT_DEATH(message_of(kSome, {11025, 1}), "check failed: coord");
}

TEST(SoundMessage, any_is_of_either_scalar_and_of_as_many_channels_as_can_be_played) {
  const auto any = hc::audio::any_sound();
  ASSERT_EQ(any.types.size(), 16);
  EXPECT_EQ(any.types.front().info, hc::sound(1).type.info);
  EXPECT_EQ(any.types.back().info, hc::sound<float>(8).type.info);
}

}  // namespace
