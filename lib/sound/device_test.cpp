// SPDX-License-Identifier: Apache-2.0
// Uses SDL drivers without a device: `disk` plays to a file and records from one.
#include <sound/device.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <hc/testing/files.h>
#include <hc/testing/must.h>
#include <sound/capture.h>
#include <sound/playback.h>

namespace {

using hc::audio::Capture;
using hc::audio::FrameClock;
using hc::audio::Playback;
using std::chrono::milliseconds;
using namespace std::chrono_literals;

class Device : public testing::Test {
 protected:
  Device() : path("/tmp/hc_sound_" + std::to_string(::getpid()) + ".raw") {
    ::setenv("SDL_AUDIODRIVER", "disk", 1);
    ::setenv("SDL_DISKAUDIOFILE", path.c_str(), 1);
    ::setenv("SDL_DISKAUDIOFILEIN", path.c_str(), 1);
    std::filesystem::remove(path);
  }
  ~Device() override { std::filesystem::remove(path); }
  std::string path;
};

TEST_F(Device, what_is_played_arrives) {
  std::vector<std::int16_t> samples;
  for (int i = 0; i < 4000; ++i) samples.push_back(static_cast<std::int16_t>(i + 1));
  auto playback = hc::must(Playback::open("", {16000, 1}));
  EXPECT_TRUE(playback->is_there());
  playback->put(samples);
  EXPECT_GT(playback->waiting(), 0);
  while (playback->waiting() > 0) std::this_thread::yield();
  playback.reset();  // flushes the device
  const std::string bytes = hc::bytes_of(path);
  const std::string sent(reinterpret_cast<const char*>(samples.data()), 2 * samples.size());
  EXPECT_NE(bytes.find(sent), std::string::npos) << bytes.size();
}

TEST_F(Device, what_is_recorded_comes_in_pieces) {
  std::vector<std::int16_t> samples;
  for (int i = 0; i < 3200; ++i) samples.push_back(static_cast<std::int16_t>(i));
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(samples.data()), 2 * std::ssize(samples));
  auto capture = hc::must(Capture::open("", {16000, 1}, 320));
  std::vector<std::int16_t> heard;
  hc::Time last;
  while (heard.size() < samples.size()) {
    auto piece = hc::must(capture->take(milliseconds(30000)));
    ASSERT_EQ(piece.samples.size(), 320);
    EXPECT_GE(piece.time, last);
    last = piece.time;
    heard.insert(heard.end(), piece.samples.begin(), piece.samples.end());
  }
  EXPECT_EQ(heard, samples);
  EXPECT_EQ(capture->lost(), 0);
}

TEST_F(Device, ends_to_wait_when_told_to_stop) {
  std::ofstream(path).close();
  auto capture = hc::must(Capture::open("", {16000, 1}, 3200));
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  EXPECT_FALSE(capture->take(milliseconds(30000), ends[0]));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(Device, none_is_an_error_that_says_so) {
  ::setenv("SDL_AUDIODRIVER", "no_such_driver", 1);
  auto playback = Playback::open("", {16000, 1});
  ASSERT_FALSE(playback);
  EXPECT_EQ(playback.error().code, hc::Code::System);
  EXPECT_TRUE(playback.error().detail.starts_with("no sound: ")) << playback.error().detail;
  EXPECT_FALSE(Capture::open("", {16000, 1}, 320));
  ::setenv("SDL_AUDIODRIVER", "disk", 1);
  ::setenv("SDL_DISKAUDIOFILE", "/no/such/folder/x", 1);
  playback = Playback::open("", {16000, 1});
  ASSERT_FALSE(playback);
  EXPECT_TRUE(playback.error().detail.starts_with("loudspeaker: ")) << playback.error().detail;
  ::setenv("SDL_DISKAUDIOFILE", path.c_str(), 1);  // and now there is one
  EXPECT_TRUE(Playback::open("", {16000, 1}));
}

TEST_F(Device, one_that_is_missing_is_reported_by_its_error_alone) {
  testing::internal::CaptureStderr();
  ::setenv("SDL_AUDIODRIVER", "alsa", 1);
  EXPECT_FALSE(Playback::open("no such device", {16000, 1}));
  EXPECT_FALSE(Capture::open("no such device", {16000, 1}, 320));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(FrameClock, counts_frames_and_starts_over_after_a_gap) {
  FrameClock clock(16000);
  constexpr hc::Time kStart(1'763'683'200s);
  constexpr auto kPiece = 20ms;
  EXPECT_EQ(clock.stamp(320, kStart), kStart - kPiece);
  // The wake-ups jitter, but the sound does not.
  EXPECT_EQ(clock.stamp(320, kStart + kPiece + 3ms), kStart);
  EXPECT_EQ(clock.stamp(320, kStart + 2 * kPiece - 3ms), kStart + kPiece);
  EXPECT_EQ(clock.stamp(320, kStart + 10 * kPiece), kStart + 9 * kPiece);
  EXPECT_EQ(clock.stamp(320, kStart + 11 * kPiece + 1ns), kStart + 10 * kPiece);
}

}  // namespace
