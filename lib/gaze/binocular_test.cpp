// SPDX-License-Identifier: Apache-2.0
#include <gaze/binocular.h>

#include <gtest/gtest.h>

#include <gaze/mounted_eyes_test.h>
#include <hc/testing/must.h>

namespace hc::gaze {
namespace {

using namespace std::chrono_literals;

constexpr auto kPeriod = 50ms;
constexpr Time kBegin = unix_time(1000);

/// The pixel at which an uncalibrated eye sees a point of the head frame [px].
Eigen::Vector2d straight_pixel_of(const Eyes& eyes, Side side, const Eigen::Vector3d& p_head) {
  const Eigen::Vector3d from = p_head - eyes.place(side);
  return {eyes.cx - eyes.focal * from.y() / from.x(), eyes.cy - eyes.focal * from.z() / from.x()};
}

TEST(Binocular, both_eyes_give_the_place_and_its_range_holds_for_one) {
  const Eyes eyes = mounted_eyes();
  const Eigen::Vector3d p(1.5, 0.2, -0.1);
  const auto left = straight_pixel_of(eyes, Side::Left, p),
             right = straight_pixel_of(eyes, Side::Right, p);
  Binocular sight;
  // A first detection of one eye gives a guess at the default range.
  const auto guess = must(sight.see(eyes, Side::Left, kBegin, left, 2.5));
  EXPECT_NEAR((guess - eyes.place(Side::Left)).norm(), 2.5, 1e-9);
  const auto both = must(sight.see(eyes, Side::Right, kBegin, right, 2.5));
  EXPECT_NEAR((both - p).norm(), 0, 1e-9);
  // The next pair: its first half alone gives no result.
  EXPECT_FALSE(sight.see(eyes, Side::Right, kBegin + kPeriod, right, 2.5));
  EXPECT_TRUE(sight.see(eyes, Side::Left, kBegin + kPeriod, left, 2.5));
  // The left eye loses it: waiting costs only two images.
  for (int i = 2; i < 4; ++i)
    EXPECT_FALSE(sight.see(eyes, Side::Right, kBegin + i * kPeriod, right, 2.5));
  for (int i = 4; i < 7; ++i) {
    const auto one = must(sight.see(eyes, Side::Right, kBegin + i * kPeriod, right, 2.5));
    EXPECT_NEAR((one - eyes.place(Side::Right)).norm(), p.norm(), 1e-9);
  }
  // A late detection of the left eye is too old.
  EXPECT_FALSE(sight.see(eyes, Side::Left, kBegin + 4 * kPeriod, left, 2.5));
}

TEST(Binocular, no_time_overflows) {
  const Eyes eyes = mounted_eyes();
  Binocular sight;
  for (Time time : {Time(), Time::max(), Time(), Time::max()}) {
    sight.see(eyes, Side::Left, time, {300, 100}, 2.5);
    sight.see(eyes, Side::Right, Time::max(), {300, 100}, 2.5);
  }
}

TEST(Binocular, what_cannot_be_the_same_is_no_target) {
  const Eyes eyes = mounted_eyes();
  Binocular sight;
  sight.see(eyes, Side::Left, kBegin, {300, 100}, 2.5);
  EXPECT_FALSE(sight.see(eyes, Side::Right, kBegin, {310, 500}, 2.5));
}

}  // namespace
}  // namespace hc::gaze
