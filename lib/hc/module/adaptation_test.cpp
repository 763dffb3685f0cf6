// SPDX-License-Identifier: Apache-2.0
#include <hc/module/adaptation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <hc/mtp/matrix_view.h>

namespace hc::internal {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr TimePoint kBegin{std::chrono::hours(1000)};
constexpr auto kPeriod = milliseconds(50);

/// A camera of 20 images/s, a link that is adapted, and a network.
struct Sent {
  Form form;
  bool is_sent = false;
  double bytes = 0;
};
struct Camera {
  double full = 120'000;  // of an image of quality 90 [byte]
  double network = 1e9;   // what it takes [byte/s]
  Adaptation adaptation;
  std::int64_t number = 0;
  Time begin{seconds(1)};  // of its images
  double waiting = 0;      // in the network [byte]

  /// Bytes of a JPEG: from 90 to 30 they fall to a quarter.
  [[nodiscard]] double size_of(const Form& form) const {
    return full * std::pow(4, (form.quality - 90) / 60.) * form.scale * form.scale;
  }
  Sent next() {
    const auto now = kBegin + number * kPeriod;
    waiting = std::max(0.0, waiting - network * 0.05);
    const auto form = adaptation.choose(begin + ++number * kPeriod, now, waiting > 0);
    if (!form) return {};
    adaptation.note_size(static_cast<std::uint64_t>(size_of(*form)));
    waiting += size_of(*form);
    return {*form, true, size_of(*form)};
  }
  std::vector<Sent> run(int images) {
    std::vector<Sent> all;
    for (int i = 0; i < images; ++i) all.push_back(next());
    return all;
  }
};

Camera camera_of(std::uint64_t bandwidth, double full = 120'000) {
  return {full, 1e9, Adaptation({bandwidth, {90, 1}})};
}

double bytes_of(const std::vector<Sent>& all) {
  double sum = 0;
  for (const auto& each : all) sum += each.bytes;
  return sum;
}

auto count_of(const std::vector<Sent>& all) {
  return std::ranges::count_if(all, &Sent::is_sent);
}

TEST(Adaptation, WithEnoughBandwidthImagesAreAtTheirBest) {
  auto camera = camera_of(10'000'000);
  camera.run(60);
  for (const auto& each : camera.run(20)) EXPECT_EQ(each.form, (Form{90, 1}));
}

TEST(Adaptation, FirstTheQualityFalls) {
  auto camera = camera_of(1'000'000);
  camera.run(60);
  const auto all = camera.run(100);
  EXPECT_EQ(count_of(all), 100);
  for (const auto& each : all) {
    EXPECT_EQ(each.form.scale, 1);
    EXPECT_NEAR(each.form.quality, 90 - 60 * std::log(120'000 / 47'500.) / std::log(4), 3);
  }
  EXPECT_GT(bytes_of(all), 4.4e6) << "the bandwidth is used";
  EXPECT_LE(bytes_of(all), 5e6);
}

TEST(Adaptation, ThenTheScaleAndItStaysAtOne) {
  auto camera = camera_of(300'000);
  camera.run(100);
  std::set<double> scales;
  const auto all = camera.run(200);
  for (const auto& each : all)
    if (each.is_sent) scales.insert(each.form.scale);
  EXPECT_EQ(scales.size(), 1U);
  EXPECT_LT(*scales.begin(), 1);
  EXPECT_EQ(count_of(all), 200);
  EXPECT_LE(bytes_of(all), 3e6);
  EXPECT_GT(bytes_of(all), 2e6);
}

TEST(Adaptation, ThenTheRateEvenly) {
  auto camera = camera_of(10'000);
  camera.run(400);
  const auto all = camera.run(400);
  EXPECT_LE(bytes_of(all), 20 * 10'000 * 1.05);
  ASSERT_GT(count_of(all), 50);
  std::vector<std::ptrdiff_t> distances;
  std::ptrdiff_t last = -1;
  for (std::ptrdiff_t i = 0; i < 400; ++i) {
    if (!all[static_cast<std::size_t>(i)].is_sent) continue;
    if (last >= 0) distances.push_back(i - last);
    last = i;
  }
  const auto [least, most] = std::ranges::minmax(distances);
  EXPECT_LE(most - least, 2);
}

TEST(Adaptation, SettlesWithinThreeSecondsWhereTheNetworkHalvesAndDoubles) {
  auto camera = camera_of(1'000'000);
  for (const double network : {600e3, 300e3, 600e3}) {
    camera.network = network;
    camera.run(60);
    const auto all = camera.run(100);
    EXPECT_LE(bytes_of(all), 5 * network * 1.02) << network;
    EXPECT_GE(bytes_of(all), 5 * network * 0.6) << network;
    EXPECT_GE(count_of(all), 60) << network;
  }
}

TEST(Adaptation, ImagesOfOneTimeAreTreatedAlike) {
  auto camera = camera_of(20'000);
  int skipped = 0;
  for (int i = 0; i < 500; ++i) {
    const auto first = camera.next();
    const Time time = camera.begin + camera.number * kPeriod;
    const auto second = camera.adaptation.choose(time, kBegin + camera.number * kPeriod, true);
    EXPECT_EQ(second.has_value(), first.is_sent);
    if (second) {
      EXPECT_EQ(*second, first.form);
      camera.adaptation.note_size(20'000);
    } else {
      ++skipped;
    }
  }
  EXPECT_GT(skipped, 100);
}

TEST(Adaptation, WhereAllAreKeptNoneIsSkipped) {
  Camera camera{120'000, 1e9, Adaptation({10'000, {90, 1}, true, false})};
  EXPECT_EQ(count_of(camera.run(300)), 300);
}

TEST(Adaptation, AWishForLessIsTheBest) {
  Camera camera{120'000, 1e9, Adaptation({10'000'000, {20, 0.5}})};
  camera.run(60);
  EXPECT_EQ(camera.next().form, (Form{20, 0.5}));
  camera.full = 1e9;
  camera.run(60);
  EXPECT_EQ(camera.adaptation.form(), (Form{20, 0.125}));
}

TEST(Adaptation, AScaleThatIsGivenStays) {
  Camera camera{120'000, 1e9, Adaptation({300'000, {90, 0.5}, false})};
  for (const auto& each : camera.run(100))
    EXPECT_EQ(each.form.scale, 0.5 * each.is_sent + !each.is_sent);
  camera.full = 1e6;
  camera.run(200);
  const auto all = camera.run(200);
  EXPECT_EQ(camera.adaptation.form(), (Form{30, 0.5}));
  EXPECT_LE(bytes_of(all), 10 * 300'000 * 1.05);
  EXPECT_LT(count_of(all), 100);
}

TEST(Adaptation, PausesAndLeapsOfTheClockHarmNothing) {
  auto camera = camera_of(1'000'000);
  camera.run(100);
  camera.number += 72'000;  // an hour
  EXPECT_TRUE(camera.next().is_sent);
  camera.begin -= std::chrono::hours(1);
  for (const auto& each : camera.run(20)) EXPECT_GE(each.form.quality, 30 * each.is_sent);
  EXPECT_GT(count_of(camera.run(20)), 15);
}

Message image_of(std::uint8_t background, std::uint8_t noise, int ball_at = 0) {
  const Info info{MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
  Draft draft = Draft::make(info, 600, 800);
  auto pixels = view<std::uint8_t>(draft);
  std::uint32_t random = 7U + noise;
  for (std::size_t y = 0; y < 600; ++y)
    for (auto& pixel : pixels.row(y)) {
      random = random * 1664525 + 1013904223;
      pixel = static_cast<std::uint8_t>(background + (random >> 24) % (noise + 1U));
    }
  for (std::size_t y = 280; ball_at > 0 && y < 320; ++y)
    std::fill_n(pixels.row(y).begin() + ball_at, 40, std::uint8_t{255});
  return std::move(draft).finish();
}

TEST(IdleRate, ImagesThatDifferByNoiseComeSlowly) {
  IdleRate idle(2);
  int passed = 0;
  for (int i = 0; i < 200; ++i)
    passed +=
        idle.lets_pass(image_of(100, static_cast<std::uint8_t>(7 + i % 2)), kBegin + i * kPeriod);
  EXPECT_EQ(passed, 20 + 18) << "all in the first second, then two a second";
}

TEST(IdleRate, ABallThatMovesLetsAllPass) {
  IdleRate idle(2);
  int passed = 0;
  for (int i = 0; i < 60; ++i) idle.lets_pass(image_of(100, 4), kBegin + i * kPeriod);
  for (int i = 60; i < 100; ++i)
    passed += idle.lets_pass(image_of(100, 4, 10 * i - 500), kBegin + i * kPeriod);
  EXPECT_EQ(passed, 40);
}

TEST(IdleRate, OtherMessagesAreComparedByteByByte) {
  IdleRate idle(0.5);
  const Info info{MatrixType::Table, 1, Scalar::F64, Encoding::Text};
  const auto number = [&](double value) {
    Draft draft = Draft::make(info, 1, 1);
    view<double>(draft).row(0)[0] = value;
    return std::move(draft).finish();
  };
  int passed = 0;
  for (int i = 0; i < 100; ++i) passed += idle.lets_pass(number(1), kBegin + i * kPeriod);
  EXPECT_EQ(passed, 20 + 2);
  EXPECT_TRUE(idle.lets_pass(number(std::nextafter(1, 2)), kBegin + 100 * kPeriod));
  EXPECT_TRUE(idle.lets_pass(number(1), kBegin + 101 * kPeriod));
}

}  // namespace
}  // namespace hc::internal
