// SPDX-License-Identifier: Apache-2.0
#include "player.h"

#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>
#include <hc/module/kind.h>
#include <hc/testing/files.h>

namespace {

using hc::audio::Format;

class PlayerTest : public testing::Test {
 protected:
  PlayerTest() {
    ::setenv("SDL_AUDIODRIVER", "disk", 1);
    ::setenv("SDL_DISKAUDIOFILE", raw.c_str(), 1);
  }

  Player player(PlayerOptions options) {
    return {std::move(options),
            [this](hc::Level, std::string_view line) { log.emplace_back(line); }, -1};
  }
  [[nodiscard]] std::vector<std::int16_t> written(const Format& format) const {
    auto reader = hc::audio::WavReader::open(wav);
    if (!reader || !(reader->format() == format)) {
      ADD_FAILURE() << (reader ? text(reader->format()) : reader.error().text());
      return {};
    }
    std::vector<std::int16_t> samples(100000);
    const auto frames = reader->read(samples);
    samples.resize(*frames * static_cast<std::size_t>(format.channels));
    return samples;
  }
  hc::Folder folder;
  const std::string wav = folder / "out.wav", raw = folder / "out.raw";
  std::vector<std::string> log;
};

const std::vector<std::int16_t> kSome = {1, 2, 3, 4, 5, 6};

TEST_F(PlayerTest, writes_a_file_that_is_whole_at_once) {
  auto to_file = player({.plays = false, .device = "", .file = wav});
  ASSERT_TRUE(to_file.play<std::int16_t>(kSome, {8000, 2}));
  EXPECT_EQ(written({8000, 2}), kSome);
  ASSERT_TRUE(to_file.play<std::int16_t>(kSome, {8000, 2}));
  EXPECT_EQ(written({8000, 2}).size(), 12);
  ASSERT_TRUE(to_file.finish());
  EXPECT_EQ(to_file.dropped(), 0);
}

TEST_F(PlayerTest, one_that_is_started_again_leaves_the_file) {
  for (std::size_t i = 1; i <= 3; ++i) {
    auto to_file = player({.plays = false, .device = "", .file = wav});
    ASSERT_TRUE(to_file.play<std::int16_t>(kSome, {8000, 2}));
    EXPECT_EQ(written({8000, 2}).size(), 6);
    EXPECT_EQ(log.size(), i - 1);
    EXPECT_FALSE(to_file.has_file_error());
  }
}

TEST_F(PlayerTest, takes_other_formats_after_the_first) {
  auto to_file = player({.plays = false, .device = "", .file = wav});
  const std::vector<std::int16_t> second(16000, 1000);
  const std::vector<float> half(24000, 0.5F);
  ASSERT_TRUE(to_file.play<std::int16_t>(second, {16000, 1}));
  ASSERT_TRUE(to_file.play<float>(half, {48000, 1}));
  ASSERT_TRUE(to_file.play<std::int16_t>(second, {8000, 2}));
  ASSERT_TRUE(to_file.finish());
  EXPECT_NEAR(static_cast<double>(written({16000, 1}).size()), 16000 + 8000 + 16000, 4);
}

TEST_F(PlayerTest, takes_messages_of_either_scalar) {
  auto to_file = player({.plays = false, .device = "", .file = wav});
  const std::vector<float> halves = {0.5F, -0.5F};
  ASSERT_TRUE(to_file.play(hc::sound(2).message(kSome), {8000, 2}));
  ASSERT_TRUE(to_file.play(hc::sound<float>(2).message(halves), {8000, 2}));
  auto samples = written({8000, 2});
  ASSERT_EQ(samples.size(), 8);
  EXPECT_NEAR(samples[6], 16384, 1);
  EXPECT_NEAR(samples[7], -16384, 1);
  samples.resize(6);
  EXPECT_EQ(samples, kSome);
  const auto failed = to_file.play(hc::table().message({1}), {8000, 2});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, hc::Code::Unsupported);
}

TEST_F(PlayerTest, says_why_a_file_cannot_be_written) {
  auto to_file = player({.plays = false, .device = "", .file = "/no/such.wav"});
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(to_file.play<std::int16_t>(kSome, {8000, 1}));
  EXPECT_TRUE(to_file.has_file_error());
  ASSERT_EQ(log.size(), 1);
  EXPECT_EQ(log.front(), "recording of sound ended: open(/no/such.wav): No such file or directory");
}

TEST_F(PlayerTest, what_is_played_plays_and_written) {
  std::vector<std::int16_t> samples;
  samples.reserve(4000);
  for (int i = 0; i < 4000; ++i) samples.push_back(static_cast<std::int16_t>(7 * i + 1));
  auto both = player({.plays = true, .device = "", .file = wav, .buffer = 0.2});
  ASSERT_TRUE(both.play<std::int16_t>(samples, {16000, 1}));
  ASSERT_TRUE(both.play<std::int16_t>(samples, {16000, 1}));
  ASSERT_TRUE(both.finish());
  const std::string bytes = hc::bytes_of(raw);
  const std::string sent(reinterpret_cast<const char*>(samples.data()), 2 * samples.size());
  EXPECT_NE(bytes.find(sent + sent), std::string::npos);
  EXPECT_EQ(written({16000, 1}).size(), 8000);
  EXPECT_TRUE(log.empty());
}

TEST_F(PlayerTest, drops_and_counts_while_there_is_no_device) {
  ::setenv("SDL_AUDIODRIVER", "no_such_driver", 1);
  auto both = player({.plays = true, .device = "", .file = wav});
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(both.play<std::int16_t>(kSome, {16000, 1}));
  EXPECT_EQ(both.dropped(), 3);
  EXPECT_EQ(written({16000, 1}).size(), 18);  // written even if not audible
  ASSERT_EQ(log.size(), 1);
  EXPECT_TRUE(log[0].ends_with("; dropping sound")) << log[0];
  ::setenv("SDL_AUDIODRIVER", "disk", 1);
  while (log.size() == 1) both.look();
  EXPECT_EQ(log[1], "loudspeaker connected; dropped 3 messages");
  ASSERT_TRUE(both.play<std::int16_t>(kSome, {16000, 1}));
  ASSERT_TRUE(both.finish());
  EXPECT_EQ(both.dropped(), 3);
}

}  // namespace
