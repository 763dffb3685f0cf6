// SPDX-License-Identifier: Apache-2.0
#include "live.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

namespace {

using std::chrono::milliseconds;
using namespace std::chrono_literals;

/// Faults that a test injects from another thread.
struct Plug {
  std::atomic<bool> is_in = true;
  std::atomic<int> opened = 0, adjusted = 0;
  std::atomic<bool> is_loose = false;  // each image is the last one
  std::atomic<bool> is_small = false;
  std::atomic<int> given = 0;
  std::atomic<hc::Time> queued{hc::Time()};  // the image before the last one
};

class FakeDevice final : public Device {
 public:
  explicit FakeDevice(Plug& plug) : plug_(plug) {}
  hc::Result<std::optional<Frame>> next(milliseconds) override {
    if (!plug_.is_in || (plug_.is_loose && ++given_ > 1))
      return hc::Error{hc::Code::Closed, "pulled out"};
    std::this_thread::sleep_for(milliseconds(1));  // its rate
    // One clock for all; otherwise images of a reconnected camera would have no partners.
    const hc::Time now(std::chrono::steady_clock::now().time_since_epoch());
    plug_.queued = std::exchange(last_, now);
    ++plug_.given;
    return std::optional<Frame>(Frame{cv::Mat(2, 2, CV_8UC3), now});
  }
  hc::Status adjust(const Adjustment& adjustment) override {
    ++plug_.adjusted;
    if (adjustment.gain > 10) return hc::Error{hc::Code::Unsupported, "too much gain"};
    return {};
  }
  [[nodiscard]] std::string remark() const override { return plug_.is_small ? "is small" : ""; }

 private:
  Plug& plug_;
  int given_ = 0;
  hc::Time last_;
};

LiveCamera camera(const std::string& name, Plug& plug) {
  return {name, [&plug]() -> hc::Result<std::unique_ptr<Device>> {
            const bool is_in = plug.is_in;  // before the test is notified of the opening
            ++plug.opened;
            if (!is_in) return hc::Error{hc::Code::NotFound, "no such camera"};
            return std::unique_ptr<Device>(std::make_unique<FakeDevice>(plug));
          }};
}

/// Takes images until one meets the condition; returns the log meanwhile. Limited by the watchdog.
template <typename Wanted>
std::vector<Remark> take_until(LiveCameras& cameras, Wanted wanted) {
  std::vector<Remark> said;
  while (true) {
    auto taken = cameras.next(milliseconds(20));
    for (auto& line : cameras.remarks()) said.push_back(std::move(line));
    if (taken && *taken && wanted(**taken)) return said;
  }
}

auto pair() {
  return [](const LiveCameras::Taken& taken) { return taken.left && taken.right; };
}

TEST(LiveCameras, gives_pairs_of_the_same_time_and_says_nothing) {
  Plug left, right;
  LiveCameras cameras({camera("left", left), camera("right", right)}, true, {});
  EXPECT_TRUE(take_until(cameras, pair()).empty());
  EXPECT_TRUE(take_until(cameras, pair()).empty());
}

TEST(LiveCameras, one_that_is_lost_is_reported_once_and_once_when_it_is_back) {
  Plug plug;
  LiveCameras cameras({camera("eye", plug)}, true, {});
  auto any = [](const LiveCameras::Taken& taken) { return taken.left.has_value(); };
  take_until(cameras, any);
  plug.is_in = false;
  const int before = plug.opened;
  while (plug.opened < before + 3) std::this_thread::yield();
  plug.is_in = true;
  std::vector<Remark> said;
  while (said.size() < 2) {
    EXPECT_TRUE(cameras.next(milliseconds(20)));
    for (auto& line : cameras.remarks()) said.push_back(line);
  }
  EXPECT_EQ(said, (std::vector<Remark>{
                      {hc::Level::Warning, "eye: disconnected: pulled out; reconnecting"},
                      {hc::Level::Info, "eye: reconnected"}}));
  take_until(cameras, any);
}

TEST(LiveCameras, the_other_one_continues_alone) {
  Plug left, right;
  LiveCameras cameras({camera("left", left), camera("right", right)}, true, {});
  take_until(cameras, pair());
  left.is_in = false;
  auto said = take_until(cameras, [](const auto& taken) { return !taken.left && taken.right; });
  EXPECT_EQ(
      said,
      (std::vector<Remark>{{hc::Level::Warning, "left: disconnected: pulled out; reconnecting"}}));
  left.is_in = true;
  said = take_until(cameras, pair());
  EXPECT_EQ(said, (std::vector<Remark>{{hc::Level::Info, "left: reconnected"}}));
}

TEST(LiveCameras, one_that_is_not_there_is_waited_for) {
  Plug plug;
  plug.is_in = false;
  LiveCameras cameras({camera("eye", plug)}, true, {});
  while (plug.opened < 2) std::this_thread::yield();
  EXPECT_EQ(
      cameras.remarks(),
      (std::vector<Remark>{{hc::Level::Warning, "eye: cannot connect: no such camera; retrying"}}));
}

TEST(LiveCameras, one_that_comes_and_goes_is_looked_for_less_and_less_often) {
  Plug plug;
  plug.is_loose = true;
  const auto begin = std::chrono::steady_clock::now();
  LiveCameras cameras({camera("eye", plug)}, true, {});
  std::size_t said = 0;
  while (plug.opened < 5) {
    EXPECT_TRUE(cameras.next(milliseconds(20)));
    said += cameras.remarks().size();
  }
  EXPECT_LE(said, 9);  // two for each time
  // 0.1 s, 0.2 s, 0.4 s, 0.8 s: a minimum on any machine.
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(1500));
}

TEST(LiveCameras, without_reopen_a_loss_is_an_error) {
  Plug plug;
  LiveCameras cameras({camera("eye", plug)}, false, {});
  take_until(cameras, [](const auto&) { return true; });
  plug.is_in = false;
  auto taken = cameras.next(milliseconds(20));
  while (taken) taken = cameras.next(milliseconds(20));
  EXPECT_EQ(taken.error().detail, "eye: pulled out");
}

/// Gives images of a rate of 1000 Hz, five at a time.
class BurstDevice final : public Device {
 public:
  explicit BurstDevice(milliseconds ahead) : time_(1000s + ahead) {}
  hc::Result<std::optional<Frame>> next(milliseconds) override {
    if (++count_ % 5 == 0) std::this_thread::sleep_for(milliseconds(5));
    return std::optional<Frame>(Frame{cv::Mat(2, 2, CV_8UC3), hc::Time(time_ += 1ms)});
  }
  hc::Status adjust(const Adjustment&) override { return {}; }

 private:
  std::chrono::nanoseconds time_;
  int count_ = 0;
};

LiveCamera burst_camera(const std::string& name, milliseconds ahead = 0ms) {
  return {name, [=]() -> hc::Result<std::unique_ptr<Device>> {
            return std::unique_ptr<Device>(std::make_unique<BurstDevice>(ahead));
          }};
}

TEST(LiveCameras, every_image_of_a_burst_is_taken) {
  LiveCameras cameras({burst_camera("eye")}, true, {});
  // A busy machine may make this reader slow.
  int most = 0;
  std::optional<hc::Time> last;
  for (int run = 0; most < 100;) {
    auto taken = cameras.next(milliseconds(20));
    ASSERT_TRUE(taken);
    if (!*taken) continue;
    const auto time = (*taken)->left->time;
    run = last && time - *last == 1ms ? run + 1 : 0;
    most = std::max(most, run);
    last = time;
  }
}

TEST(LiveCameras, a_reader_that_has_paused_gets_the_newest) {
  Plug plug;
  LiveCameras cameras({camera("eye", plug)}, true, {});
  take_until(cameras, [](const auto&) { return true; });
  const int before = plug.given;
  while (plug.given < before + 700) std::this_thread::yield();  // a second, about
  const hc::Time queued = plug.queued;
  const auto taken = cameras.next(milliseconds(20));
  ASSERT_TRUE(taken && *taken);
  EXPECT_GE((*taken)->left->time, queued);
}

TEST(LiveCameras, no_pairs_are_said_once) {
  LiveCameras cameras({burst_camera("left"), burst_camera("right", 90s)}, true, {});
  std::vector<Remark> said;
  while (said.empty()) {
    auto taken = cameras.next(milliseconds(20));
    ASSERT_TRUE(taken);
    EXPECT_FALSE(*taken);
    said = cameras.remarks();
  }
  ASSERT_EQ(said.size(), 1);
  EXPECT_TRUE(said[0].text.starts_with("left, right: no pairs for 3 s, so no images are sent"))
      << said[0].text;
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(cameras.next(milliseconds(20)));
    EXPECT_TRUE(cameras.remarks().empty());
  }
}

TEST(Thinning, keeps_a_rate_and_holds_nothing_back) {
  auto taken = [](double camera, double rate) {
    Thinning thinning;
    int count = 0;
    for (int i = 0; i < 10 * camera; ++i)
      count += thinning.takes(hc::Time(1000s + hc::duration(i / camera)), rate) ? 1 : 0;
    return count;
  };
  EXPECT_EQ(taken(30, 0), 300);
  EXPECT_NEAR(taken(30, 20), 200, 2);
  EXPECT_NEAR(taken(30, 7), 70, 2);
  EXPECT_EQ(taken(20, 20), 200);
  EXPECT_EQ(taken(5, 20), 50);
  Thinning thinning;
  EXPECT_TRUE(thinning.takes(hc::Time(1000s), 10));
  EXPECT_FALSE(thinning.takes(hc::Time(1000s + 50ms), 10));
  EXPECT_TRUE(thinning.takes(hc::Time(5s), 10));  // after the clock was set back
}

TEST(LiveCameras, what_differs_is_reported_once) {
  Plug plug;
  plug.is_small = true;
  LiveCameras cameras({camera("eye", plug)}, true, {});
  auto any = [](const LiveCameras::Taken&) { return true; };
  EXPECT_EQ(take_until(cameras, any), std::vector<Remark>({{hc::Level::Warning, "eye: is small"}}));
  plug.is_in = false;
  while (plug.opened < 2) std::this_thread::yield();
  plug.is_in = true;
  const auto said = take_until(cameras, [&](const auto&) { return plug.opened > 2; });
  EXPECT_EQ(std::ranges::count(said, "eye: is small", &Remark::text), 0);
}

TEST(LiveCameras, is_set_to_its_own_choice_from_the_beginning) {
  Plug plug;
  LiveCameras cameras({camera("eye", plug)}, true, {});
  take_until(cameras, [](const auto&) { return true; });
  EXPECT_EQ(plug.adjusted, 1);
}

TEST(LiveCameras, what_cannot_be_set_is_reported_and_images_continue) {
  Plug plug;
  LiveCameras cameras({camera("eye", plug)}, true, {0, 11});
  auto adjusted = [&](const auto&) { return plug.adjusted > 0; };
  EXPECT_EQ(take_until(cameras, adjusted),
            std::vector<Remark>({{hc::Level::Warning, "eye: too much gain"}}));
  cameras.adjust({0.01, 3});
  EXPECT_TRUE(take_until(cameras, [&](const auto&) { return plug.adjusted == 2; }).empty());
}

}  // namespace
