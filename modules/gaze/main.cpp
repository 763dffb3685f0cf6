// SPDX-License-Identifier: Apache-2.0
// Turns the head to where a task wants it to look, and bids for the head while it wants that.
#include <algorithm>
#include <cmath>
#include <optional>

#include <frames/track.h>
#include <gaze/aim.h>
#include <gaze/follower.h>
#include <hc/adapter/eigen.h>
#include <hc/adapter/pose.h>
#include <hc/node/module.h>

namespace {

using hc::gaze::Angles;

constexpr std::int32_t kRobot = 2, kHead = 3, kLeftImage = 7, kRightImage = 8, kGaze = 13;
constexpr double kSecond = 1e-9;  // of a nanosecond
/// How far back the first picture of a pair may be from the second to be taken together with it.
constexpr std::int64_t kPair = 1'000'000;  // [ns]

/// How often a push is said again: the first time may come before the head is given to who pushes.
constexpr std::chrono::milliseconds kSteer{5};

/// How long a push counts that is not told again [ns].
constexpr std::int64_t kTold = 100'000'000;

/// What a stick steers.
struct Steering {
  Angles at;          ///< where it has come to [rad]
  Angles rates;       ///< [rad/s]
  std::int64_t time;  ///< of `at` [ns]
};

/// What was seen in one eye's picture.
struct Sighting {
  std::int64_t time = 0;
  Eigen::Vector2d pixel;
};

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"gaze",
                    "Turns the head to a target, and bids for the head while there is one."};
  auto target =
      module.input("target", hc::position<double>(),
                   "what is to be looked at: x, y in the left picture (7) or the right "
                   "one (8) [px], or its place in the robot's frame (2) or the head's (3) [m]");
  auto wish = module.input("wish", hc::rotation<double>(), "roll, tilt, pan to take [rad]");
  auto stick = module.input("stick", hc::table<double>(),
                            "1 x 2: turn to the left, turn down, -1 … 1 of stick_rate");
  auto report = module.input("gaze", hc::rotation<double>().in(kGaze), "how the head stands");
  auto command = module.output("command", hc::rotation<double>().in(kGaze),
                               "roll 0, tilt, pan that the head is to take [rad]");
  auto bid = module.output("bid", hc::table<double>(),
                           "salience while there is a target, else that of rest");

  auto rate =
      module.parameter("rate", 100.0, "Hz", "commands a second", {.least = 1, .most = 1000});
  auto salience = module.parameter("salience", 0.5, "", "of the bid", {.least = 0, .most = 1});
  auto rest = module.parameter("rest", 0.0, "",
                               "salience with which it looks straight ahead while there is no "
                               "target, 0: it does nothing then",
                               {.least = 0, .most = 1});
  auto patience =
      module.parameter("patience", 0.5, "s", "how long a target counts that is not seen any more",
                       {.least = 0.01, .most = 60});
  auto noise = module.parameter("noise", 0.003, "rad", "standard deviation of a target's angles",
                                {.least = 1e-6, .most = 1, .fixed = true});
  auto liveliness = module.parameter("liveliness", 2.0, "rad/s²",
                                     "standard deviation of what speeds a target up: more follows "
                                     "it more closely, and its noise",
                                     {.least = 1e-3, .most = 1e3, .fixed = true});
  auto predict = module.parameter("predict", 0.01, "s",
                                  "how far ahead: what passes from a command to the motion",
                                  {.least = 0, .most = 1});
  auto acceleration =
      module.parameter("acceleration", 1.795, "rad/s²",
                       "of the unit, which brakes to stand still where it is sent; 0: it does not",
                       {.least = 0, .most = 1000});
  auto base_speed =
      module.parameter("base_speed", 0.8976, "rad/s",
                       "with which the unit starts and stops at once; only faster it accelerates",
                       {.least = 0, .most = 100});
  auto dead_zone = module.parameter("dead_zone", 0.0, "rad",
                                    "nothing is done about a target so near to the middle",
                                    {.least = 0, .most = 1});
  auto stick_rate = module.parameter("stick_rate", 1.0, "rad/s", "of a stick that is pushed fully",
                                     {.least = 0.01, .most = 10});
  auto pan_most =
      module.parameter("pan_most", 2.77, "rad", "to either side", {.least = 0, .most = 3.2});
  auto tilt_most = module.parameter("tilt_most", 0.81, "rad", "down", {.least = 0, .most = 1.6});
  auto tilt_least = module.parameter("tilt_least", -0.54, "rad", "up", {.least = -1.6, .most = 0});
  auto focal = module.parameter("focal", 600.0, "px", "focal length of the eyes",
                                {.least = 1, .fixed = true});
  auto cx = module.parameter("cx", 399.5, "px", "middle of the pictures", {.fixed = true});
  auto cy = module.parameter("cy", 299.5, "px", "middle of the pictures", {.fixed = true});
  auto baseline = module.parameter("baseline", 0.1, "m", "distance of the eyes",
                                   {.least = 0, .most = 1, .fixed = true});
  auto distance = module.parameter("distance", 2.5, "m", "of a target that one eye alone has seen",
                                   {.least = 0.2});

  hc::gaze::Eyes eyes;
  std::optional<hc::gaze::Follower> follower;
  hc::frames::Track gazes{hc::frames::Memory{}};
  std::optional<Sighting> sightings[2];
  double range = 0;                  // of the last target that both eyes saw [m]
  std::optional<Steering> steering;  // while a stick is out of its middle
  std::int64_t pushed = 0;           // when a stick was out of its middle [ns]
  bool was_wanted = false;           // as it was bid last

  module.on_start([&] {
    eyes.focal = *focal;
    eyes.cx = *cx;
    eyes.cy = *cy;
    eyes.baseline = *baseline;
    follower.emplace(hc::gaze::FollowerOptions{*noise, *liveliness, *patience});
  });

  /// How the head stood at a time, as far as it is known.
  auto R_robot_head = [&](std::int64_t time) {
    if (gazes.empty()) return Eigen::Quaterniond::Identity();
    const auto known = gazes.known();
    return gazes.at(std::clamp(time, known.first, known.last)).q;
  };
  auto stands = [&] { return hc::gaze::angles_of(R_robot_head(module.now())); };

  auto send = [&](const Angles& to, std::int64_t time) {
    auto draft = command.loan(1, 1);
    draft.header.time = time;
    auto numbers = draft.matrix().numbers();
    numbers[0] = 0;
    numbers[1] = std::clamp(to.tilt, *tilt_least, *tilt_most);
    numbers[2] = std::clamp(to.pan, -*pan_most, *pan_most);
    command.send(std::move(draft));
  };
  auto lead = [&](double speed) {
    return *acceleration > 0 ? hc::gaze::braking(speed, {*acceleration, *base_speed}) : 0;
  };
  /// Sends the head to where the target is when it gets there.
  auto follow = [&] {
    const std::int64_t now = module.now();
    const auto seen = follower->last();
    if (!seen || static_cast<double>(now) * kSecond - *seen > *patience) {
      if (*rest > 0) send({0, 0}, now);
      return;
    }
    const auto motion = *follower->at(static_cast<double>(now) * kSecond + *predict);
    if (hc::gaze::between(motion.angles, stands()) < *dead_zone) return;
    send({motion.angles.pan + lead(motion.pan_rate), motion.angles.tilt + lead(motion.tilt_rate)},
         now);
  };

  auto see = [&](std::int64_t time, const Eigen::Vector3d& p_robot) {
    follower->see(static_cast<double>(time) * kSecond, hc::gaze::aim(p_robot, eyes.middle));
  };
  auto see_pixel = [&](int side, std::int64_t time, const Eigen::Vector2d& pixel) {
    sightings[side > 0 ? 0 : 1] = Sighting{time, pixel};
    const auto& other = sightings[side > 0 ? 1 : 0];
    const auto q = R_robot_head(time);
    if (other && std::abs(other->time - time) <= kPair) {
      const auto& left = *sightings[0];
      const auto& right = *sightings[1];
      if (auto p_head = eyes.place_of(left.pixel, right.pixel)) {
        range = p_head->norm();
        see(time, q * *p_head);
      }
      return;
    }
    // Its partner comes yet, unless this eye alone sees it.
    if (other && std::abs(time - other->time) < std::llround(*patience / kSecond)) return;
    const double from = range > 0 ? range : *distance;
    see(time, q * (eyes.place(side) + from * eyes.direction(side, pixel.x(), pixel.y())));
  };

  module.on(report, [&](const auto& message) {
    if (message.header.time <= 0) return;
    hc::frames::Pose pose;
    pose.q = hc::value_or_end(hc::rotation_of(message));
    gazes.add(message.header.time, pose);
  });
  module.on(target, [&](const auto& message) {
    if (message.header.empty()) return;
    const auto numbers = message.matrix().numbers();
    const std::int64_t time = message.header.time > 0 ? message.header.time : module.now();
    const Eigen::Vector3d p(numbers[0], numbers[1], numbers[2]);
    if (!p.allFinite()) return;
    if (message.header.coord == kLeftImage || message.header.coord == kRightImage)
      see_pixel(message.header.coord == kLeftImage ? 1 : -1, time, p.head<2>());
    else if (message.header.coord == kHead)
      see(time, R_robot_head(time) * p);
    else if (message.header.coord == kRobot)
      see(time, p);
    else
      throw hc::ModuleError("target: coordinate system " + std::to_string(message.header.coord) +
                            " is none of 2, 3, 7, 8");
    follow();
  });
  module.on(wish, [&](const auto& message) {
    const auto q = hc::rotation_of(message);
    if (!q) return module.log("wish: " + q.error().detail);
    const std::int64_t time = message.header.time > 0 ? message.header.time : module.now();
    follower->see(static_cast<double>(time) * kSecond, hc::gaze::angles_of(*q));
    follow();
  });
  /// Whether it wants the head.
  auto wants = [&] {
    const auto now = static_cast<double>(module.now()) * kSecond;
    const auto seen = follower->last();
    return (seen && now - *seen <= *patience) ||
           (pushed > 0 && now - static_cast<double>(pushed) * kSecond <= *patience);
  };
  auto tell_bid = [&] {
    was_wanted = wants();
    auto message = hc::table({was_wanted ? *salience : *rest});
    message.header.time = module.now();
    bid.send(message);
  };
  /// Moves what a stick steers on to now, never far from how the head stands.
  auto advance = [&](std::int64_t now) {
    constexpr double kReach = 0.1;  // [rad]
    const auto stood = stands();
    const double dt = static_cast<double>(now - steering->time) * kSecond;
    steering->time = now;
    auto moved = [&](double at, double by_rate, double from) {
      return std::clamp(at + by_rate * dt, from - kReach, from + kReach);
    };
    steering->at = {moved(steering->at.pan, steering->rates.pan, stood.pan),
                    moved(steering->at.tilt, steering->rates.tilt, stood.tilt)};
  };
  /// Sends the head on while a stick is pushed and told of.
  auto steer = [&] {
    constexpr double kAhead = 0.02;  // so that it moves at once, and on if one comes late [s]
    const std::int64_t now = module.now();
    if (!steering || now - pushed > kTold) return;
    advance(now);
    const auto& [at, rates, time] = *steering;
    send({at.pan + rates.pan * kAhead + lead(rates.pan),
          at.tilt + rates.tilt * kAhead + lead(rates.tilt)},
         time);
  };
  module.on(stick, [&](const auto& message) {
    const auto numbers = message.matrix().numbers();
    if (numbers.size() < 2 || !std::isfinite(numbers[0]) || !std::isfinite(numbers[1])) return;
    const Angles rates{std::clamp(numbers[0], -1.0, 1.0) * *stick_rate,
                       std::clamp(numbers[1], -1.0, 1.0) * *stick_rate};
    const std::int64_t now = module.now();
    if (steering && now - pushed > kTold) steering.reset();
    if (steering) advance(now);
    if (rates.pan == 0 && rates.tilt == 0) {
      if (steering) send(steering->at, now);
      steering.reset();
      return;
    }
    if (!steering) steering = Steering{stands(), rates, now};
    steering->rates = rates;
    pushed = now;
    // Who pushes does not wait for the next bid.
    if (!was_wanted) tell_bid();
    steer();
  });

  module.every(rate, follow);
  module.every(kSteer, steer);
  module.every(std::chrono::milliseconds(100), tell_bid);
  return module.run(argc, argv);
}
