// SPDX-License-Identifier: Apache-2.0
// Scores how well a head follows a ball, against the ground truth of a simulation.
#include <cmath>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <gaze/track_score.h>
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  constexpr auto kWorldLeftEye = hc::transform_coord(hc::Coord::kWorld, hc::Coord::kLeftEye);
  hc::Module module{"track_score",
                    "Compares the direction of a head's eyes with the position of a ball."};
  auto eye = module.input("left_pose", hc::transformation().in(kWorldLeftEye),
                          "truth: T_world_left_eye", {.keep = 64});
  auto ball = module.input("ball", hc::position(6).in(hc::Coord::kWorld), "truth: of the ball [m]",
                           {.keep = 64});
  auto seen = module.input("ball_seen", hc::table().of(1, 4),
                           "truth; the last number is the visible share", {.keep = 64});
  auto begin = module.input("begin", hc::table(),
                            "the first message restarts the score: as calibrate's result");
  auto result = module.output("score", hc::table().of(1, 5),
                              "RMS error [rad], time to acquire it [s], times that it came "
                              "back, longest time to acquire it then [s], samples");
  auto duration =
      module.parameter("duration", 20.0, "s", "how long it is scored", {.min = 0.1, .max = 1e6});
  auto within = module.parameter("within", 0.0524, "rad", "maximum error of an acquired ball",
                                 {.min = 1e-4, .max = 1});
  hc::ModuleFrames frames{module, {.input = false}};
  auto timeout =
      module.parameter("timeout", 60.0, "s", "to wait for an image", {.min = 1, .max = 3600});

  hc::gaze::Track track;
  std::int64_t waits = 0;  // periods since an image
  module.on(begin, [&](const auto&) { track.begin(); });
  module.on(
      hc::together(eye, ball, seen), [&](const auto& pose, const auto& place, const auto& share) {
        const auto T_world_left_eye = hc::value_or_drop(hc::pose_of(pose)).T_to_from;
        const auto p = place.numbers();
        const Eigen::Vector3d to = T_world_left_eye.inverse() * Eigen::Vector3d(p[0], p[1], p[2]) -
                                   frames.fixed("left_eye", "right_eye").translation() / 2;
        waits = 0;
        track.add({hc::seconds(pose.header.time.time_since_epoch()),
                   std::atan2(to.head<2>().norm(), to.z()), share.numbers()[3]});
        if (track.duration() < *duration) return;
        const auto score = track.score(*within);
        result.send(score.numbers());
        module.log(score.text(), hc::Level::Result);
        module.stop();
      });
  constexpr std::chrono::milliseconds kLook{20};
  module.every(kLook, [&] {
    if (++waits * kLook > hc::duration(*timeout)) throw hc::ModuleError("no image within timeout");
  });
  return module.run(argc, argv);
}
