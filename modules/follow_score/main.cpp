// SPDX-License-Identifier: Apache-2.0
// Scores how well a head follows a setpoint, against the ground truth of a simulation.
#include <algorithm>

#include <frames/messages.h>
#include <gaze/follow_score.h>
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  constexpr std::int32_t kGaze = hc::Coord::kGaze, kSupervisor = hc::Coord::kSupervisor;
  hc::Module module{"follow_score", "Compares the orientation of a head with its setpoints."};
  auto setpoint =
      module.input("setpoint", hc::any_of(hc::rotation().in(kGaze), hc::rotation().in(kSupervisor)),
                   "truth: setpoint roll, tilt, pan [rad]", {.keep = 64});
  auto motion = module.input("motion", hc::rotation().in(kGaze),
                             "truth: roll, tilt, pan of the head [rad]", {.keep = 64});
  auto result = module.output("score", hc::table().of(1, 4),
                              "RMS error [rad], maximum error [rad], delay [s], samples");
  auto settle = module.parameter("settle", 2.0, "s", "delay of the scoring after the first of both",
                                 {.min = 0, .max = 1e6});
  auto duration =
      module.parameter("duration", 10.0, "s", "how long it is scored", {.min = 0.1, .max = 1e6});
  auto timeout =
      module.parameter("timeout", 60.0, "s", "to wait for a gaze of each", {.min = 1, .max = 3600});

  std::vector<hc::gaze::TimedAngles> wanted, turned;
  std::int64_t waits[2] = {};  // periods since a setpoint, a motion
  auto take = [](auto& samples, auto& wait, const auto& message) {
    wait = 0;
    const double time = hc::seconds(message.header.time.time_since_epoch());
    const auto q = hc::value_or_drop(hc::rotation_of(message));
    if (samples.empty() || time > samples.back().time)
      samples.push_back({time, hc::gaze::angles_of(q)});
  };
  auto score_if_done = [&] {
    if (wanted.empty() || turned.empty()) return;
    const double begin = std::max(wanted.front().time, turned.front().time) + *settle;
    const double end = begin + *duration;
    if (wanted.back().time < end || turned.back().time < end) return;
    const auto score = hc::gaze::score_follow(wanted, turned, begin, end);
    result.send(score.numbers());
    module.log(score.text(), hc::Level::Result);
    module.stop();
  };
  module.on(setpoint, [&](const auto& message) {
    take(wanted, waits[0], message);
    score_if_done();
  });
  module.on(motion, [&](const auto& message) {
    take(turned, waits[1], message);
    score_if_done();
  });
  constexpr std::chrono::milliseconds kLook{50};
  module.every(kLook, [&] {
    for (auto& wait : waits)
      if (++wait * kLook > hc::duration(*timeout))
        throw hc::ModuleError("no gaze of both within timeout");
  });
  return module.run(argc, argv);
}
