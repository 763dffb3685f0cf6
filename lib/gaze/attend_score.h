// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scores how well a head looks at people, given their true places. Pure.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace hc::gaze {

/// A person in an image, as a simulation knows.
struct TruePerson {
  int number = 0;         ///< from 1
  Eigen::Vector2d error;  ///< from the gaze to the middle between the eyes: right, down [rad]
  double distance = 0;    ///< [m]
  bool speaks = false;
  double visible = 0;  ///< share, 0 … 1
};

struct AttendScore {
  double rms = 0;                   ///< error once on target [rad]
  std::optional<double> on_target;  ///< after the first person was visible [s]
  double overshoot = 0;             ///< beyond the person, in the direction of the first turn [rad]
  std::optional<double> settled;    ///< until the error stays within the limit [s]
  int turns = 0;                    ///< times that a person began to speak
  int right_turns = 0;              ///< of these, how often the head looked at them in time

  [[nodiscard]] std::array<double, 6> numbers() const;
  /// "RMS error 0.50°, on target after 0.45 s, …"
  [[nodiscard]] std::string text() const;
};

/// Collects a run.
class Attending {
 public:
  /// @param within  maximum error of the gaze on target [rad].
  explicit Attending(double within) : within_(within) {}

  /// Takes the people of an image. The head is to look at the one who speaks, else at the nearest.
  void see(double time, const std::vector<TruePerson>& people);

  /// From the first image with a visible person to the last [s].
  [[nodiscard]] double duration() const;
  [[nodiscard]] AttendScore score() const;

 private:
  struct Sample {
    double time = 0;
    int person = 0;  // to be looked at
    bool speaks = false;
    Eigen::Vector2d error;
  };
  [[nodiscard]] std::optional<double> settled() const;
  void score_turns(AttendScore& score) const;

  double within_;
  std::vector<Sample> samples_;
};

}  // namespace hc::gaze
