// SPDX-License-Identifier: Apache-2.0
// Simulates a robot head in a room: images, sound, and the ground truth.
#include <limits>
#include <memory>
#include <optional>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>

#include <room/ball.h>
#include <room/world.h>
#include "ears.h"
#include "eyes.h"
#include "parameters.h"
#include "schedule.h"
#include "truth.h"

namespace {

constexpr double kTick = 250;                   // how often the schedule is checked [Hz]
const Eigen::Vector3d kUnderground(0, 0, -10);  // position of an absent ball [m]

/// Made when the parameters are known.
struct Scene {
  std::unique_ptr<hc::graphics::Renderer> renderer;
  hc::room::World world;
  hc::room::Ball ball;
  hc::room::Head head;
  hc::graphics::PinholeCamera camera;
  Schedule schedule;
  Eyes eyes;
  Ears ears;
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"simulator", "A robot head in a furnished room: eyes, ears and ground truth."};
  auto gaze = module.input("gaze", hc::rotation().in(hc::Coord::kGaze),
                           "roll, tilt, pan of the pan-tilt unit [rad]; straight ahead without");
  auto text = module.input("text", hc::string(), "text to write on the board");
  auto left =
      module.output("left", hc::rgb_image().in(hc::Coord::kLeftImage), "left eye");
  auto right =
      module.output("right", hc::rgb_image().in(hc::Coord::kRightImage), "right eye");
  auto sound = module.output("sound", hc::sound(2).in(hc::Coord::kSound16k),
                             "sound at the left and right ear");
  Truth truth(module);
  const Parameters parameters{module};

  // The head's pose comes from the input `gaze`.
  hc::ModuleFrames frames{module, {.input = false}};
  std::unique_ptr<Scene> scene;
  std::string last_parameter;
  module.on_start([&] {
    auto renderer = hc::value_or_end(hc::graphics::Renderer::make());
    auto& drawing = *renderer;
    hc::room::World world(drawing, parameters.world_seed(), *parameters.text);
    const hc::room::Head mounted{frames.fixed("head", "left_eye"),
                                 frames.fixed("head", "right_eye")};
    const hc::room::Head head = mounted.with(parameters.faults());
    const auto ear = [&](const char* name) -> Eigen::Vector3d {
      if (!sound.linked()) return Eigen::Vector3d::Zero();
      return frames.fixed("head", name).translation();
    };
    // Time starts only now, since making the world takes a while.
    const std::int64_t start = *parameters.start > 0 ? *parameters.start : module.now();
    scene.reset(new Scene{std::move(renderer), std::move(world),
                          hc::room::Ball(parameters.motion()), head, parameters.camera(),
                          Schedule(start, *parameters.rate),
                          Eyes(parameters, head, drawing, left, right),
                          Ears(ear("left_ear"), ear("right_ear"), sound, start)});
    last_parameter = *parameters.text;
  });

  auto write = [&](const std::string& what) {
    scene->world.write(what);
    truth.send_board(module.now(), what);
  };
  module.on(gaze, [&](const auto& message) {
    const auto q = hc::rotation_of(message);
    if (!q) return module.log("gaze: " + q.error().detail);
    if (message.header.time <= 0) return;
    auto fed = frames.feed("robot", "head", message.header.time, Eigen::Isometry3d(*q));
    if (!fed) module.log("gaze: " + fed.error().detail);
  });
  module.on(text, [&](const auto& message) { write(std::string(message.text())); });

  auto look = [&](const Eigen::Vector3d& ball, const Eigen::Isometry3d& T_world_head) {
    const auto& camera = scene->camera;
    const auto time = scene->schedule.time();
    const View view{time, scene->schedule.number(), T_world_head, scene->world.items(ball),
                    scene->world.light()};
    if (!truth.depth.linked() || *parameters.swapped) return scene->eyes.take(view, nullptr);
    auto depth = truth.depth.loan(camera.height, camera.width);
    depth.header.time = time;
    cv::Mat metres = hc::as_mat(depth);
    scene->eyes.take(view, &metres);
    truth.depth.send(std::move(depth));
  };
  auto take = [&] {
    const auto& schedule = scene->schedule;
    const auto time = schedule.time();
    const Eigen::Isometry3d T_world_head = frames.nearest("world", "head", time);
    const auto ball = scene->ball.at(schedule.seconds());
    const bool is_absent = *parameters.ball == "absent";
    look(is_absent ? kUnderground : ball.position, T_world_head);
    truth.send_poses(time, T_world_head, scene->head);
    truth.send_ball(time, ball, !is_absent, T_world_head * scene->head.left_eye, scene->camera);
    if (schedule.begins_second()) {
      truth.send_board(time, scene->world.text());
      truth.send_markers(time, scene->world.markers());
    }
    scene->ears.hear_until(time, T_world_head);
  };
  module.generate([&] {
    const bool is_paced = *parameters.paced;
    if (is_paced) module.keep_rate(kTick);
    if (*parameters.text != last_parameter) write(last_parameter = *parameters.text);
    const std::int64_t now = module.now();
    scene->eyes.send_due(is_paced ? now : std::numeric_limits<std::int64_t>::max());
    auto& schedule = scene->schedule;
    if (*parameters.count > 0 && schedule.number() >= *parameters.count)
      return scene->eyes.empty() ? module.stop() : void();
    if (is_paced) schedule.catch_up(now);
    if (is_paced && !schedule.is_due(now, frames.awaits("world", "head", schedule.time())))
      return;
    take();
    schedule.next();
  });
  return module.run(argc, argv);
}
