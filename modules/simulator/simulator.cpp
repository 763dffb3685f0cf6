// SPDX-License-Identifier: Apache-2.0
#include "simulator.h"

#include <limits>
#include <utility>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <vision/messages.h>

namespace {

constexpr double kTick = 250;  // how often the schedule is checked [Hz]
constexpr auto kAll = hc::Time::max();
const Eigen::Vector3d kUnderground(0, 0, -10);       // position of an absent ball [m]
const Eigen::Vector3d kLoudspeaker(2.4, -1.6, 0.7);  // in the world [m]

}  // namespace

Simulator::Simulator(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(text_, [this](const auto& message) { write(std::string(message.text())); });
  module.generate([this] { generate(); });
  module.on(gaze_, [this](const auto& message) { take_gaze(message); });
}

void Simulator::start() {
  scene_ = make_scene();
  last_parameter_ = *parameters_.text;
  const auto delay = hc::duration(*parameters_.neck_delay);
  if (delay.count() == 0 || *parameters_.paced) return;
  neck_.emplace(delay, scene_->schedule.time());
  module_.generate({});  // `step` takes the images
}

std::unique_ptr<Simulator::Scene> Simulator::make_scene() {
  auto renderer = hc::value_or_end(hc::graphics::Renderer::make());
  auto& drawing = *renderer;
  hc::room::World world(drawing, parameters_.world_seed(), *parameters_.text,
                        static_cast<int>(*parameters_.people));
  const hc::room::Head mounted{frames_.fixed("head", "left_eye"),
                               frames_.fixed("head", "right_eye")};
  const hc::room::Head head = mounted.with(parameters_.faults());
  const auto ear = [this](const char* name) -> Eigen::Vector3d {
    if (!sound_.linked()) return Eigen::Vector3d::Zero();
    return frames_.fixed("head", name).translation();
  };
  // Time starts only now, since making the world takes a while.
  const auto start = *parameters_.start > 0 ? hc::unix_time(*parameters_.start) : module_.now();
  return std::unique_ptr<Scene>(
      new Scene{std::move(renderer), std::move(world), hc::room::Ball(parameters_.motion()),
                hc::room::People(parameters_.motion_of_people()), head, parameters_.camera(),
                Schedule(start, *parameters_.rate), Eyes(parameters_, head, drawing, left_, right_),
                Ears(ear("left_ear"), ear("right_ear"), sound_, start)});
}

void Simulator::write(const std::string& what) {
  scene_->world.write(what);
  truth_.send_board(module_.now(), what);
}

void Simulator::write_parameter() {
  if (*parameters_.text != last_parameter_) write(last_parameter_ = *parameters_.text);
}

void Simulator::take_gaze(const hc::Message& message) {
  const auto q = hc::rotation_of(message);
  if (!q) return module_.log("gaze: " + q.error().detail);
  const auto time = message.header.time;
  if (time <= hc::Time())
    return module_.log_once("gaze without a time", "gaze dropped: it has no time");
  if (!neck_) return turn(time, *q);
  neck_->add(time, *q);
  step_.restart(kNow);
}

void Simulator::turn(hc::Time time, const Eigen::Quaterniond& R_robot_head) {
  auto fed = frames_.feed("robot", "head", time, Eigen::Isometry3d(R_robot_head));
  if (!fed) module_.log("gaze: " + fed.error().detail);
}

void Simulator::generate() {
  const bool is_paced = *parameters_.paced;
  if (is_paced) module_.keep_rate(kTick);
  write_parameter();
  const hc::Time now = module_.now();
  scene_->eyes.send_due(is_paced ? now : kAll);
  if (is_done()) return scene_->eyes.empty() ? module_.stop() : void();
  auto& schedule = scene_->schedule;
  if (is_paced) schedule.catch_up(now);
  if (is_paced && !schedule.is_due(now, frames_.awaits("world", "head", schedule.time()))) return;
  take();
  schedule.next();
}

// The image of a time says that this time has come, and is taken when all poses until then are
// known. So nothing depends on how fast the modules are.
void Simulator::step() {
  if (!neck_) return;
  auto& schedule = scene_->schedule;
  if (is_done()) return module_.stop();
  if (!neck_->knows(schedule.time())) return;
  write_parameter();
  while (const auto pose = neck_->next(schedule.time())) turn(pose->time, pose->R_robot_head);
  take();
  scene_->eyes.send_due(kAll);
  schedule.next();
  silence_.restart();
  step_.restart(kNow);
}

void Simulator::fail_by_silence() const {
  if (neck_)
    throw hc::ModuleError(
        hc::format("gaze: image {} has waited {} s for a pose: a module of the loop sent nothing "
                   "for an image, or neck_delay is too short",
                   scene_->schedule.number(), kSilence.count()));
}

void Simulator::take() {
  const auto& schedule = scene_->schedule;
  const auto time = schedule.time();
  const Eigen::Isometry3d T_world_head = frames_.nearest("world", "head", time);
  const auto ball = scene_->ball.at(schedule.seconds());
  const bool has_ball = parameters_.has_ball();
  const auto people = scene_->people.at(schedule.seconds());
  look(scene_->world.items(has_ball ? ball.position : kUnderground, people), T_world_head);
  const Eigen::Isometry3d T_world_left = T_world_head * scene_->head.left_eye;
  truth_.send_poses(time, T_world_head, scene_->head);
  if (neck_pose_.linked())
    neck_pose_.send(hc::numbers_of(frames_.nearest("robot", "head", time)), time);
  truth_.send_ball(time, ball, has_ball, T_world_left, scene_->camera);
  people_truth_.send(time, people, T_world_left, scene_->camera);
  if (schedule.begins_second()) {
    truth_.send_board(time, scene_->world.text());
    truth_.send_markers(time, scene_->world.markers());
  }
  scene_->ears.hear_until(time, T_world_head, sources(people));
}

std::vector<hc::room::Source> Simulator::sources(const std::vector<hc::room::Person>& people) {
  if (people.empty()) return {{kLoudspeaker, hc::room::chirps}};
  std::vector<hc::room::Source> voices;
  for (const auto& person : people) {
    const int number = person.number;
    voices.push_back({hc::room::mouth_of(person),
                      [this, number](double t) { return scene_->people.voice_of(number, t); }});
  }
  return voices;
}

void Simulator::look(const std::vector<hc::graphics::Item>& items,
                     const Eigen::Isometry3d& T_world_head) {
  const auto& camera = scene_->camera;
  const auto time = scene_->schedule.time();
  const View view{time, scene_->schedule.number(), T_world_head, items, scene_->world.light()};
  if (!truth_.depth.linked() || *parameters_.swapped) return scene_->eyes.take(view, nullptr);
  auto depth = truth_.depth.loan(camera.height, camera.width);
  depth.header.time = time;
  cv::Mat metres = hc::as_mat(depth);
  scene_->eyes.take(view, &metres);
  truth_.depth.send(std::move(depth));
}

bool Simulator::is_done() const {
  return *parameters_.count > 0 && scene_->schedule.number() >= *parameters_.count;
}
