// SPDX-License-Identifier: Apache-2.0
#include <sound/converter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include <hc/testing/must.h>

namespace {

using hc::audio::Converter;
using hc::audio::Format;
using Scalar = Converter::Scalar;

/// One second of a 400 Hz tone in all channels.
std::vector<std::int16_t> tone(const Format& format) {
  std::vector<std::int16_t> samples;
  for (int i = 0; i < format.rate; ++i)
    for (int channel = 0; channel < format.channels; ++channel)
      samples.push_back(static_cast<std::int16_t>(
          std::lround(10000 * std::sin(2 * std::numbers::pi * 400 * i / format.rate))));
  return samples;
}

TEST(Converter, a_tone_stays_a_tone_at_all_rates) {
  for (int from : hc::audio::kRates)
    for (int to : hc::audio::kRates)
      for (int channels : {1, 2}) {
        auto converter = hc::must(Converter::make(Scalar::I16, {from, channels}, {to, 1}));
        converter.put(tone({from, channels}));
        converter.finish();
        const auto got = converter.take();
        EXPECT_NEAR(static_cast<double>(got.size()), to, 2) << from << " to " << to;
        // Frequency by zero crossings, and loudness, away from the ends.
        int crossings = 0;
        double energy = 0;
        const auto tenth = static_cast<std::size_t>(to / 10);
        for (std::size_t i = tenth; i < 9 * tenth; ++i) {
          crossings += (got[i] < 0) != (got[i + 1] < 0);
          energy += double(got[i]) * got[i];
        }
        EXPECT_NEAR(crossings, 640, 3) << from << " to " << to;
        EXPECT_NEAR(std::sqrt(energy / (8.0 * static_cast<double>(tenth))), 7071, 400);
      }
}

TEST(Converter, the_end_is_not_cut_off) {
  auto converter = hc::must(Converter::make(Scalar::I16, {22050, 1}, {16000, 1}));
  std::vector<std::int16_t> samples(22050);
  std::fill(samples.end() - 220, samples.end(), std::int16_t{20000});  // a click of 10 ms
  std::vector<std::int16_t> got;
  for (std::size_t at = 0; at < samples.size(); at += 441) {
    converter.put(std::span(std::as_const(samples)).subspan(at, 441));
    const auto more = converter.take();
    got.insert(got.end(), more.begin(), more.end());
  }
  converter.finish();
  const auto more = converter.take();
  got.insert(got.end(), more.begin(), more.end());
  EXPECT_NEAR(static_cast<double>(got.size()), 16000, 2);
  EXPECT_GT(*std::max_element(got.end() - 200, got.end()), 15000);
}

TEST(Converter, the_same_format_is_as_it_was) {
  auto converter = hc::must(Converter::make(Scalar::I16, {16000, 2}, {16000, 2}));
  const auto samples = tone({16000, 2});
  converter.put(samples);
  EXPECT_EQ(converter.take(), samples);
  EXPECT_TRUE(converter.take().empty());
}

TEST(Converter, floats_are_cut_off_and_rubbish_is_silence) {
  auto converter = hc::must(Converter::make(Scalar::F32, {8000, 1}, {8000, 1}));
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const float samples[] = {0, 0.5, -0.5, 7, -7, std::nanf(""), kInfinite, -kInfinite};
  converter.put(samples);
  const auto got = converter.take();
  const std::int16_t expected[] = {0, 16384, -16384, 32767, -32768, 0, 32767, -32768};
  ASSERT_EQ(got.size(), 8);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(got[i], expected[i], 1) << i;
}

TEST(Converter, knows_what_it_takes) {
  auto converter = hc::must(Converter::make(Scalar::F32, {8000, 1}, {16000, 2}));
  EXPECT_TRUE(converter.takes(Scalar::F32, {8000, 1}));
  EXPECT_FALSE(converter.takes(Scalar::I16, {8000, 1}));
  EXPECT_FALSE(converter.takes(Scalar::F32, {8000, 2}));
  EXPECT_FALSE(Converter::make(Scalar::I16, {0, 1}, {16000, 1}));
  EXPECT_FALSE(Converter::make(Scalar::I16, {8000, 9}, {16000, 1}));
  EXPECT_FALSE(Converter::make(Scalar::I16, {8000, 1}, {16000, 0}));
}

}  // namespace
