// SPDX-License-Identifier: Apache-2.0
#pragma once
// Compares hands, and the places at which they point, with the truth. Pure.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <people/hand.h>
#include <room/truth_rows.h>

inline constexpr std::size_t kJoints = hc::people::Hand::kPoints;

/// The hands and the place pointed at, as a simulation knows them at the time of an image.
struct TrueScene {
  std::vector<hc::room::TrueHand> hands;
  std::optional<Eigen::Vector3d> pointed;  ///< in the world [m]
};

class Score {
 public:
  /// Takes a place that was found, in the world, while somebody points. [m]
  void add_place(const TrueScene& scene, const Eigen::Vector3d& found);
  /// Takes the joints that were found in an image. Those of no true hand do not count. [px]
  void add_hand(const TrueScene& scene, const std::array<Eigen::Vector2d, kJoints>& found);

  /// Medians: angle between the true and the found place, seen from the finger tip [rad], distance
  /// of the joints of a hand [px]; places, hands. -1 where there was none.
  [[nodiscard]] std::array<double, 4> numbers() const;
  /// "pointed-at place 3.10° off in 50 % of 200 images, …"
  [[nodiscard]] std::string text() const;

 private:
  std::vector<double> angles_, distances_;
};
