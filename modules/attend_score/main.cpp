// SPDX-License-Identifier: Apache-2.0
// Scores how well a head looks at people, against the ground truth of a simulation.
#include <cmath>
#include <vector>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <gaze/attend_score.h>
#include <hc/module/module.h>
#include <room/truth_rows.h>
#include <transports/all.h>

namespace {

using Rows = hc::MatrixView<const double>;

/// @param T_eye_world  of an optical frame midway between the eyes.
std::vector<hc::gaze::TruePerson> people_of(const Rows& rows,
                                            const Eigen::Isometry3d& T_eye_world) {
  std::vector<hc::gaze::TruePerson> people;
  for (std::size_t i = 0; i < rows.height(); ++i) {
    const auto row = hc::read_row<hc::room::PersonColumns, hc::room::PersonRow>(rows.row(i));
    if (!row) continue;
    const Eigen::Vector3d p = T_eye_world * row->p_world;
    people.push_back({row->person,
                      {std::atan2(p.x(), p.z()), std::atan2(p.y(), p.z())},
                      p.norm(),
                      row->speaks,
                      row->visible});
  }
  return people;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  constexpr auto kWorldLeftEye = hc::transform_coord(hc::Coord::kWorld, hc::Coord::kLeftEye);
  hc::Module module{"attend_score",
                    "Compares the direction of a head's eyes with the people in a simulated room."};
  auto eye = module.input("left_pose", hc::transformation().in(kWorldLeftEye),
                          "truth: T_world_left_eye", {.keep = 64});
  auto truth = module.input("people", hc::table().of(0, hc::room::kPersonColumns),
                            "truth: of the simulator", {.keep = 64});
  auto result = module.output("score", hc::table().of(1, 6), "at the end",
                              {.columns = {"RMS error [rad]", "on target [s]", "overshoot [rad]",
                                           "settled [s]", "turns", "right turns"}});
  auto duration =
      module.parameter("duration", 20.0, "s", "how long it is scored", {.min = 0.1, .max = 1e6});
  auto within = module.parameter("within", 0.0524, "rad", "maximum error of a person looked at",
                                 {.min = 1e-4, .max = 1, .fixed = true});
  auto timeout =
      module.parameter("timeout", 60.0, "s", "to wait for an image", {.min = 1, .max = 3600});
  hc::ModuleFrames frames{module, {.input = false}};

  std::optional<hc::gaze::Attending> run;
  auto silence = module.after(std::chrono::seconds(60),
                              [] { throw hc::ModuleError("no image within timeout"); });
  module.on_start([&] {
    run.emplace(*within);
    silence.restart(hc::duration(*timeout));
  });
  module.on(hc::together(eye, truth), [&](const auto& pose, const auto& rows) {
    silence.restart(hc::duration(*timeout));
    const auto T_world_eye = hc::value_or_drop(hc::pose_of(pose)).T_to_from;
    const Eigen::Translation3d middle(frames.fixed("left_eye", "right_eye").translation() / 2);
    const auto people = people_of(rows.matrix(), (T_world_eye * middle).inverse());
    run->see(hc::seconds(pose.header.time.time_since_epoch()), people);
    if (run->duration() < *duration) return;
    const auto score = run->score();
    result.send(score.numbers());
    module.log(score.text(), hc::Level::Result);
    module.stop();
  });
  return module.run(argc, argv);
}
