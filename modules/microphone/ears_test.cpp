// SPDX-License-Identifier: Apache-2.0
#include "ears.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <poll.h>

namespace {

using std::chrono::milliseconds;

class Ears : public testing::Test {
 protected:
  Ears() : path("/tmp/hc_ears_" + std::to_string(::getpid()) + ".wav") {}
  ~Ears() override { std::filesystem::remove(path); }
  void save(const hc::audio::Format& format, std::size_t samples) const {
    auto writer = hc::audio::WavWriter::create(path, format);
    ASSERT_TRUE(writer);
    std::vector<std::int16_t> all(samples);
    for (std::size_t i = 0; i < samples; ++i) all[i] = static_cast<std::int16_t>(i % 1000);
    ASSERT_TRUE(writer->write(all));
  }
  std::string path;
};

TEST_F(Ears, a_file_comes_whole_in_pieces) {
  save({16000, 1}, 1000);
  auto ear = FileEar::open(path, {16000, 1});
  ASSERT_TRUE(ear);
  std::vector<std::int16_t> all;
  for (const int frames : {320, 320, 320, 40}) {
    auto piece = ear->next();
    ASSERT_TRUE(piece && *piece);
    EXPECT_EQ((*piece)->header.width, frames);
    EXPECT_EQ((*piece)->header.time, hc::unix_time(std::ssize(all) * 62'500));
    const auto samples = (*piece)->numbers();
    all.insert(all.end(), samples.begin(), samples.end());
  }
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(*ear->next());
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i % 1000);
}

TEST_F(Ears, a_file_is_given_in_the_format_asked_for) {
  save({8000, 2}, 16000);  // 1 s
  auto ear = FileEar::open(path, {16000, 1});
  ASSERT_TRUE(ear);
  std::int32_t frames = 0;
  while (true) {
    auto piece = ear->next();
    ASSERT_TRUE(piece);
    if (!*piece) break;
    EXPECT_EQ((*piece)->header.coord, hc::Coord::kSound16k);
    frames += (*piece)->header.width;
  }
  EXPECT_NEAR(frames, 16000, 200);
}

TEST_F(Ears, an_empty_file_is_at_its_end_at_once) {
  save({16000, 2}, 0);
  auto ear = FileEar::open(path, {16000, 1});
  ASSERT_TRUE(ear);
  EXPECT_FALSE(*ear->next());
}

TEST_F(Ears, a_missing_microphone_is_logged_once_and_found_later) {
  ::setenv("SDL_AUDIODRIVER", "no_such_driver", 1);
  std::vector<std::string> log;
  DeviceEar ear("", {16000, 1}, [&](hc::Level, std::string_view line) { log.emplace_back(line); });
  for (int i = 0; i < 3; ++i) ear.look();
  EXPECT_EQ(ear.descriptor(), -1);
  EXPECT_FALSE(ear.next());
  ASSERT_EQ(log.size(), 1);
  EXPECT_TRUE(log[0].starts_with("no sound: ")) << log[0];
  ::setenv("SDL_AUDIODRIVER", "dummy", 1);  // gives silence, in real time
  std::optional<Piece> piece;
  while (!(piece = ear.next())) {
    ear.look();
    pollfd heard{ear.descriptor(), POLLIN, 0};
    ::poll(&heard, 1, 10);
    ASSERT_LE(log.size(), 2);
  }
  EXPECT_EQ(piece->header.width, 320);
  EXPECT_GT(piece->header.time, hc::Time());
  ASSERT_EQ(log.size(), 2);
  EXPECT_EQ(log[1], "microphone connected");
}

}  // namespace
