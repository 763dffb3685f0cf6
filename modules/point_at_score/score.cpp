// SPDX-License-Identifier: Apache-2.0
#include "score.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <hc/base/format.h>
#include <hc/base/median.h>

namespace {

using hc::people::Hand;

/// A wrist that is farther from a true one belongs to no hand. [px]
constexpr double kSameHand = 60;

double median_of(const std::vector<double>& numbers) {
  return numbers.empty() ? -1 : hc::median(numbers);
}

}  // namespace

void Score::add_place(const TrueScene& scene, const Eigen::Vector3d& found) {
  if (!scene.pointed || scene.hands.empty()) return;
  // The hand that points is raised towards the place: its tip is the nearest.
  const auto tip_of = [](const auto& hand) { return hand.joints[Hand::IndexTip]; };
  const auto nearest =
      std::min_element(scene.hands.begin(), scene.hands.end(), [&](const auto& a, const auto& b) {
        return (tip_of(a) - *scene.pointed).norm() < (tip_of(b) - *scene.pointed).norm();
      });
  const Eigen::Vector3d tip = tip_of(*nearest);
  const Eigen::Vector3d truly = *scene.pointed - tip, seen = found - tip;
  angles_.push_back(std::atan2(truly.cross(seen).norm(), truly.dot(seen)));
}

void Score::add_hand(const TrueScene& scene, const std::array<Eigen::Vector2d, kJoints>& found) {
  const hc::room::TrueHand* nearest = nullptr;
  double least = kSameHand;
  for (const auto& hand : scene.hands) {
    const double apart = (hand.pixels[Hand::Wrist] - found[Hand::Wrist]).norm();
    if (apart >= least) continue;
    least = apart;
    nearest = &hand;
  }
  if (nearest == nullptr) return;
  std::vector<double> apart;
  for (std::size_t i = 0; i < kJoints; ++i) apart.push_back((nearest->pixels[i] - found[i]).norm());
  distances_.push_back(hc::median(std::move(apart)));
}

std::array<double, 4> Score::numbers() const {
  return {median_of(angles_), median_of(distances_), double(angles_.size()),
          double(distances_.size())};
}

std::string Score::text() const {
  if (angles_.empty() && distances_.empty()) return "no hand was found";
  const auto [angle, distance, places, hands] = numbers();
  return hc::format(
      "places pointed at {:.2f}° off in the median of {} images, joints {:.1f} px in that of {}",
      angle < 0 ? -1 : angle * 180 / M_PI, places, distance, hands);
}
