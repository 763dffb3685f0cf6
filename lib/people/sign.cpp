// SPDX-License-Identifier: Apache-2.0
#include <people/sign.h>

#include <algorithm>
#include <cmath>

namespace hc::people {
namespace {

constexpr float kBent = 1.5F;     // minimum bend() of a bent finger [rad]
constexpr float kApart = 0.8F;    // between fingers that point and those that do not [rad]
constexpr float kUpwards = 0.9F;  // maximum angle from the image's vertical [rad]

float angle(const cv::Point3f& a, const cv::Point3f& b) {
  return std::atan2(static_cast<float>(cv::norm(a.cross(b))), a.dot(b));
}

bool is_up(const cv::Point3f& direction) {
  return angle(direction, {0, -1, 0}) < kUpwards;
}

/// Whether the index and the middle finger are spread.
bool is_spread(const Hand& hand) {
  constexpr float kSpread = 0.28F;  // simulated persons spread them by 0.30 to 0.39 [rad]
  const auto& p = hand.world;
  return angle(p[Hand::IndexTip] - p[Hand::Index], p[Hand::MiddleTip] - p[Hand::Middle]) > kSpread;
}

/// Whether the thumb is stretched away from the hand.
bool is_thumb_out(const Hand& hand) {
  constexpr float kAway = 0.45F;  // of the distance from the wrist to the middle knuckle
  const auto& p = hand.world;
  const auto palm = cv::norm(p[Hand::Middle] - p[Hand::Wrist]);
  const auto away = std::min(cv::norm(p[Hand::ThumbTip] - p[Hand::Index]),
                             cv::norm(p[Hand::ThumbTip] - p[Hand::Index + 1]));
  return away > kAway * palm && angle(p[Hand::Thumb + 2] - p[Hand::Thumb + 1],
                                      p[Hand::ThumbTip] - p[Hand::Thumb + 2]) < kStraight;
}

}  // namespace

Sign sign_of(const Hand& hand) {
  std::array<float, 4> bends{};  // from the index to the little finger
  std::size_t finger = 0;
  for (const auto knuckle : {Hand::Index, Hand::Middle, Hand::Ring, Hand::Little})
    bends[finger++] = bend(hand, knuckle);
  // From the side, the network may take the index finger for the little one too: that one does not
  // count.
  const std::size_t counted = is_from_side(hand) ? bends.size() - 1 : bends.size();
  const auto are = [&](std::size_t begin, std::size_t end, const auto& which) {
    return std::all_of(bends.begin() + static_cast<std::ptrdiff_t>(begin),
                       bends.begin() + static_cast<std::ptrdiff_t>(end), which);
  };
  /// Whether the first fingers are straight, and the others are not, by far.
  const auto points_with = [&](std::size_t count) {
    const float most =
        *std::max_element(bends.begin(), bends.begin() + static_cast<std::ptrdiff_t>(count));
    float others = 0;
    for (std::size_t i = count; i < counted; ++i)
      others += bends[i] / static_cast<float>(counted - count);
    return most < kStraight && others - most > kApart &&
           are(count, counted, [](float by) { return by >= kStraight; });
  };
  const auto& p = hand.world;
  if (are(0, bends.size(), [](float by) { return by < kStraight; }))
    return is_up(p[Hand::Middle] - p[Hand::Wrist]) && is_up(p[Hand::MiddleTip] - p[Hand::Middle])
               ? Sign::Open
               : Sign::None;
  if (points_with(1)) return Sign::Point;
  if (points_with(2)) return is_spread(hand) ? Sign::Victory : Sign::Point;
  if (!are(0, bends.size(), [](float by) { return by > kBent; })) return Sign::None;
  if (!is_thumb_out(hand)) return Sign::Fist;
  return is_up(p[Hand::ThumbTip] - p[Hand::Thumb + 1]) ? Sign::ThumbUp : Sign::None;
}

std::optional<Sign> SignHold::update(Time time, Sign sign) {
  const Time last = std::max(held_.last, other_.last);
  if (time < last || time - last > kSilence) {
    held_ = other_ = {sign, time, time};
    is_told_ = false;
  } else if (sign == held_.sign) {
    held_.last = time;
  } else {
    if (sign != other_.sign || other_.last < held_.last) other_ = {sign, time, time};
    other_.last = time;
    if (time - held_.last <= gap_) return std::nullopt;
    held_ = other_;
    is_told_ = false;
  }
  if (held_.sign == Sign::None || is_told_ || time - held_.since < hold_) return std::nullopt;
  is_told_ = true;
  return held_.sign;
}

}  // namespace hc::people
