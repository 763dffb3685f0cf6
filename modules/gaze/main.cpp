// SPDX-License-Identifier: Apache-2.0
// Turns the head to where a task wants it to look, and bids for the head while it wants that.
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include <frames/track.h>
#include <gaze/binocular.h>
#include <gaze/follower.h>
#include <gaze/stick.h>
#include <hc/adapter/eigen.h>
#include <hc/adapter/pose.h>
#include <hc/node/module.h>
#include <vision/calibration.h>

namespace {

using hc::gaze::Angles;
using hc::gaze::Side;

constexpr std::int32_t kRobot = 2, kHead = 3, kLeftImage = 7, kRightImage = 8, kGaze = 13;
constexpr double kSecond = 1e-9;  // of a nanosecond
/// How often a push is said again: the first time may come before the head is given to who pushes.
constexpr std::chrono::milliseconds kSteer{5};

/// A target may be so far in the future, by another clock [ns].
constexpr std::int64_t kAhead = 200'000'000;
/// Reports come in the order of time, but where a clock was set back [ns].
constexpr std::int64_t kSetBack = 1'000'000'000;

/// A target as it came.
struct Sensed {
  std::int64_t time;
  std::int32_t coord;
  Eigen::Vector3d p;
};
constexpr std::size_t kMostSensed = 64;  // that wait

double seconds(std::int64_t time) {
  return static_cast<double>(time) * kSecond;
}

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
  auto calibration =
      module.input("calibration", hc::table<double>(), "how the eyes sit: calibrate's result");
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
  auto predict = module.parameter("predict", 0.03, "s",
                                  "how far ahead: what passes from a command to the motion",
                                  {.least = 0, .most = 1});
  auto horizon = module.parameter("horizon", 0.2, "s",
                                  "so long a target that is not seen any more goes on as it moved",
                                  {.least = 0, .most = 10, .fixed = true});
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
  auto file = module.parameter("calibration_file", "", "",
                               "what stereo_calibration and calibrate wrote; without it focal, cx, "
                               "cy hold",
                               {.fixed = true});
  auto focal = module.parameter("focal", 600.0, "px", "focal length of the eyes",
                                {.least = 1, .fixed = true});
  auto cx = module.parameter("cx", 399.5, "px", "middle of the pictures", {.fixed = true});
  auto cy = module.parameter("cy", 299.5, "px", "middle of the pictures", {.fixed = true});
  auto baseline = module.parameter("baseline", 0.1, "m", "distance of the eyes",
                                   {.least = 0, .most = 1, .fixed = true});
  auto distance = module.parameter("distance", 2.5, "m", "of a target that one eye alone has seen",
                                   {.least = 0.2});

  hc::gaze::Eyes eyes;
  std::optional<hc::vision::StereoCalibration> cameras;
  std::optional<hc::gaze::Follower> follower;
  std::deque<Sensed> sensed;  // of which it is not known yet how the head stood
  hc::gaze::Binocular binocular;
  hc::gaze::Stick steering;
  hc::frames::Track gazes{hc::frames::Memory{}};
  bool was_wanted = false;  // as it was bid last
  bool was_ahead = false;   // the last target's time was in the future

  module.on_start([&] {
    eyes.focal = *focal;
    eyes.cx = *cx;
    eyes.cy = *cy;
    eyes.baseline = *baseline;
    follower.emplace(hc::gaze::FollowerOptions{*noise, *liveliness, *patience, *horizon});
    if (file->empty()) return;
    cameras = hc::value_or_end(hc::vision::read_calibration(*file));
    eyes.baseline = cameras->baseline();
    if (!cameras->head.empty())
      eyes.calibration = hc::value_or_end(hc::gaze::HeadCalibration::of(cameras->head));
    else
      eyes.calibration.offset = hc::gaze::rotation_vector(cameras->R_left_right());
  });

  auto now = [&] { return seconds(module.now()); };
  /// How the head stood at a time, as far as it is known.
  auto R_robot_head = [&](std::int64_t time) {
    if (gazes.empty()) return Eigen::Quaterniond::Identity();
    return gazes.nearest(time).q;
  };
  auto stands = [&] { return hc::gaze::angles_of(R_robot_head(module.now())); };

  auto send = [&](const Angles& to) {
    auto draft = command.loan(1, 1);
    draft.header.time = module.now();
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
    const auto seen = follower->last();
    if (!seen || now() - *seen > *patience) {
      if (*rest > 0) send({0, 0});
      return;
    }
    const auto motion = *follower->at(now() + *predict);
    if (hc::gaze::between(motion.angles, stands()) < *dead_zone) return;
    send({motion.angles.pan + lead(motion.pan_rate), motion.angles.tilt + lead(motion.tilt_rate)});
  };

  auto see = [&](std::int64_t time, const Eigen::Vector3d& p_robot) {
    follower->see(seconds(time), hc::gaze::aim(p_robot, eyes.cyclopean()));
  };
  auto see_pixel = [&](bool is_left, std::int64_t time, Eigen::Vector2d pixel) {
    if (eyes.calibration.swapped) is_left = !is_left;
    if (cameras) {
      const auto ray =
          hc::vision::ray_of(*cameras, is_left ? hc::vision::Eye::Left : hc::vision::Eye::Right,
                             {pixel.x(), pixel.y()});
      pixel = {eyes.cx + eyes.focal * ray[0], eyes.cy + eyes.focal * ray[1]};
    }
    const auto p_head =
        binocular.see(eyes, is_left ? Side::Left : Side::Right, time, pixel, *distance);
    if (p_head) see(time, R_robot_head(time) * *p_head);
  };
  /// Takes in the targets of whose times it is known how the head stood.
  auto see_sensed = [&] {
    for (; !sensed.empty() && !gazes.awaits(sensed.front().time, module.now()); sensed.pop_front()) {
      const auto& [time, coord, p] = sensed.front();
      if (coord == kLeftImage || coord == kRightImage)
        see_pixel(coord == kLeftImage, time, p.head<2>());
      else
        see(time, coord == kHead ? R_robot_head(time) * p : p);
    }
  };

  /// When something was sensed, by the time of its message; nothing of what is to come, since it
  /// would hold back all that is sensed until then.
  auto sensed_at = [&](std::int64_t time) -> std::optional<std::int64_t> {
    if (time <= 0) return module.now();
    const std::int64_t ahead = time - module.now();
    const bool is_ahead = ahead > kAhead;
    if (is_ahead && !was_ahead)
      module.log("left out: a target " + std::to_string(ahead / 1'000'000) +
                 " ms in the future, as others may be");
    was_ahead = is_ahead;
    if (is_ahead) return std::nullopt;
    return time;
  };

  module.on(calibration, [&](const auto& message) {
    auto found = hc::gaze::HeadCalibration::of(message.matrix().numbers());
    if (!found) return module.log("calibration: " + found.error().detail);
    eyes.calibration = *found;
  });
  module.on(report, [&](const auto& message) {
    const std::int64_t time = message.header.time;
    const auto q = hc::rotation_of(message);
    if (!q) return module.log("gaze: " + q.error().detail);
    if (time <= 0) return;
    // A clock that was set back: what was known is not of its times.
    if (!gazes.empty() && gazes.known().last - time > kSetBack) gazes.clear();
    hc::frames::Pose pose;
    pose.q = *q;
    gazes.add(time, pose);
    see_sensed();
  });
  module.on(target, [&](const auto& message) {
    if (message.header.empty()) return;
    const auto numbers = message.matrix().numbers();
    const auto time = sensed_at(message.header.time);
    const Eigen::Vector3d p(numbers[0], numbers[1], numbers[2]);
    if (!time || !p.allFinite()) return;
    const std::int32_t coord = message.header.coord;
    if (coord != kLeftImage && coord != kRightImage && coord != kHead && coord != kRobot)
      throw hc::ModuleError("target: coordinate system " + std::to_string(coord) +
                            " is none of 2, 3, 7, 8");
    if (sensed.size() == kMostSensed) sensed.pop_front();
    sensed.push_back({*time, coord, p});
    see_sensed();
    follow();
  });
  module.on(wish, [&](const auto& message) {
    const auto q = hc::rotation_of(message);
    if (!q) return module.log("wish: " + q.error().detail);
    const auto time = sensed_at(message.header.time);
    if (!time) return;
    follower->see(seconds(*time), hc::gaze::angles_of(*q));
    follow();
  });
  /// Whether it wants the head.
  auto wants = [&] {
    auto is_fresh = [&](std::optional<double> last) { return last && now() - *last <= *patience; };
    return is_fresh(follower->last()) || is_fresh(steering.last());
  };
  auto tell_bid = [&] {
    was_wanted = wants();
    auto message = hc::table({was_wanted ? *salience : *rest});
    message.header.time = module.now();
    bid.send(message);
  };
  /// Sends the head on while a stick is pushed and told of.
  auto steer = [&] {
    constexpr double kLead = 0.02;  // so that it moves at once, and on if one comes late [s]
    const auto motion = steering.at(now(), stands());
    if (!motion) return;
    send({motion->angles.pan + motion->pan_rate * kLead + lead(motion->pan_rate),
          motion->angles.tilt + motion->tilt_rate * kLead + lead(motion->tilt_rate)});
  };
  module.on(stick, [&](const auto& message) {
    const auto numbers = message.matrix().numbers();
    if (numbers.size() < 2 || !std::isfinite(numbers[0]) || !std::isfinite(numbers[1])) return;
    steering.push({std::clamp(numbers[0], -1.0, 1.0) * *stick_rate,
                   std::clamp(numbers[1], -1.0, 1.0) * *stick_rate},
                  now(), stands());
    // Who pushes does not wait for the next bid.
    if (!was_wanted && wants()) tell_bid();
    steer();
  });

  module.every(rate, [&] {
    see_sensed();
    follow();
  });
  module.every(kSteer, steer);
  module.every(std::chrono::milliseconds(100), tell_bid);
  return module.run(argc, argv);
}
