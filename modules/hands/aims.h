// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rays of pointing hands, which wait for depth images of their time. Pure.

#include <chrono>
#include <deque>
#include <optional>

#include <hc/base/time.h>
#include <people/pointing.h>

/// Where a hand pointed to at a time.
struct Aim {
  hc::Time time;
  hc::people::Ray ray;
};

class Aims {
 public:
  /// Maximum time between an aim and a depth image that shows its place.
  static constexpr std::chrono::milliseconds kApart{150};
  static constexpr std::size_t kMost = 64;

  void add(const Aim& aim);
  /// The aim nearest to the time of a depth image; it and those before it are dropped.
  std::optional<Aim> take(hc::Time time);

 private:
  std::deque<Aim> waiting_;
};

/// A ray that several images agree on, since a single one may be far off. Pure.
class SteadyAim {
 public:
  /// Rays of the last while count.
  static constexpr std::chrono::milliseconds kWhile{500};
  static constexpr std::size_t kLeast = 3;
  /// Maximum median angle between the ray and the others. [rad]
  static constexpr double kSpread = 0.3;

  /// Takes a ray, in a frame in which hands do not move when the head does.
  void add(const Aim& aim);
  /// The ray that is nearest to the others, those from the eye if there are some; nothing while too
  /// few agree.
  [[nodiscard]] std::optional<Aim> find() const;

 private:
  std::deque<Aim> last_;
};
