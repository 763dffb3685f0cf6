// SPDX-License-Identifier: Apache-2.0
// How well a head follows a ball, by the truth of a simulation.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <gaze/track_score.h>
#include <hc/module/module.h>

int main(int argc, char** argv) {
  constexpr std::int32_t kWorld = 1, kWorldLeftEye = 1004;
  hc::Module module{"track_score", "Compares where a head's eyes look with where a ball is."};
  auto eye = module.input("left_pose", hc::transformation<double>(4, 4).in(kWorldLeftEye),
                          "truth: T_world_left_eye");
  auto ball = module.input("ball", hc::position<double>(6).in(kWorld), "truth: of the ball [m]");
  auto seen = module.input("ball_seen", hc::table<double>().of(4, 1),
                           "truth, of which the last number is the share that is seen");
  auto begin = module.input("begin", hc::table<double>(),
                            "the first message begins the score anew: as calibrate's result");
  auto result = module.output("score", hc::table<double>().of(5, 1),
                              "RMS error [rad], time to acquire it [s], times that it came "
                              "back, longest time to acquire it then [s], samples");
  auto duration =
      module.parameter("duration", 20.0, "s", "how long it is scored", {.min = 0.1, .max = 1e6});
  auto within = module.parameter("within", 0.0524, "rad", "an error up to this has acquired it",
                                 {.min = 1e-4, .max = 1});
  hc::ModuleFrames frames{module, {.input = false}};
  auto timeout = module.parameter("timeout", 60.0, "s", "for an image, then it fails",
                                  {.min = 1, .max = 3600});

  std::vector<hc::gaze::TrackSample> samples;
  bool has_begun = false;
  std::int64_t waits = 0;  // looks since an image
  module.on(begin, [&](const auto&) {
    if (!std::exchange(has_begun, true)) samples.clear();
  });
  module.on(
      hc::together(eye, ball, seen), [&](const auto& pose, const auto& place, const auto& share) {
        const auto T_world_left_eye = hc::value_or_end(hc::pose_of(pose)).T_to_from;
        const auto p = place.matrix().numbers();
        const Eigen::Vector3d to = T_world_left_eye.inverse() * Eigen::Vector3d(p[0], p[1], p[2]) -
                                   frames.fixed("left_eye", "right_eye").translation() / 2;
        waits = 0;
        samples.push_back({static_cast<double>(pose.header.time) * 1e-9,
                           std::atan2(to.head<2>().norm(), to.z()), share.matrix().numbers()[3]});
      });
  module.generate([&] {
    constexpr double kLook = 50;  // [Hz]
    module.keep_rate(kLook);
    if (static_cast<double>(++waits) > *timeout * kLook)
      throw hc::ModuleError("no image within timeout");
    if (samples.empty() || samples.back().time - samples.front().time < *duration) return true;
    const auto score = hc::gaze::score_track(samples, *within);
    const double longest =
        score.again.empty() ? 0 : *std::max_element(score.again.begin(), score.again.end());
    const bool is_lost =
        std::any_of(score.again.begin(), score.again.end(), [](double took) { return took < 0; });
    result.send(
        hc::table({score.rms, score.acquired.value_or(-1), static_cast<double>(score.again.size()),
                   is_lost ? -1 : longest, static_cast<double>(score.samples)}));
    char line[200];
    if (!score.acquired)
      std::snprintf(
          line, sizeof line,
          "the ball was never acquired, RMS error %.2f° of %zu images: can the finder see "
          "it (exposure, colour)?",
          score.rms * 180 / M_PI, score.samples);
    else
      std::snprintf(line, sizeof line,
                    "RMS error %.2f°, acquired after %.2f s, came back %zu times, acquired again "
                    "after %.2f s at most, of %zu images",
                    score.rms * 180 / M_PI, *score.acquired, score.again.size(),
                    is_lost ? -1 : longest, score.samples);
    module.log(std::string("result: ") + line);
    return false;
  });
  return module.run(argc, argv);
}
