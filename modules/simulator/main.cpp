// SPDX-License-Identifier: Apache-2.0
// A robot head and the world before it: what its eyes see and its ears hear, and how it really is.
#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <optional>

#include <frames/track.h>
#include <hc/adapter/eigen.h>
#include <hc/adapter/opencv.h>
#include <hc/adapter/pose.h>
#include <hc/node/module.h>

#include "ball.h"
#include "head.h"
#include "screen.h"
#include "sensor.h"
#include "sounds.h"
#include "world.h"

namespace {

constexpr std::int32_t kWorld = 1, kHead = 3, kLeftEye = 4, kRightEye = 5;
constexpr std::int32_t kLeftImage = 7, kRightImage = 8, kDepth = 11, kGaze = 13, kSound16k = 21;
constexpr std::int32_t to_from(std::int32_t to, std::int32_t from) {
  return 1000 * to + from;
}

constexpr double kTick = 250;  // how often it is looked whether a picture is due [Hz]
constexpr std::chrono::milliseconds kGazeLate{100};  // a gaze that comes later is not waited for
const Eigen::Vector3d kSpeakerPlace(2.4, -1.6, 0.7);

/// When so many periods of a rate [Hz] have passed, without adding up errors. [ns]
std::int64_t period_end(std::int64_t number, double rate) {
  return static_cast<std::int64_t>(static_cast<long double>(number) * 1e9L / rate);
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"simulator", "A robot head in a furnished room: eyes, ears and ground truth."};
  auto gaze = module.input("gaze", hc::rotation<double>().in(kGaze),
                           "roll, tilt, pan of the pan-tilt unit [rad]; straight ahead without");
  auto writing = module.input("text", hc::string(), "what is to stand on the board");
  auto left = module.output("left", hc::rgb_image<std::uint8_t>().in(kLeftImage), "left eye");
  auto right = module.output("right", hc::rgb_image<std::uint8_t>().in(kRightImage), "right eye");
  auto sound = module.output("sound", hc::sound<std::int16_t>(2).in(kSound16k),
                             "what the ears hear, left and right");
  auto depth = module.output("depth", hc::intensity_image<float>().in(kDepth),
                             "truth: depth of the left picture [m], 0 where nothing is");
  auto head_pose =
      module.output("head_pose", hc::transformation<double>(4, 4).in(to_from(kWorld, kHead)),
                    "truth: T_world_head as the pictures were taken");
  auto left_pose =
      module.output("left_pose", hc::transformation<double>(4, 4).in(to_from(kWorld, kLeftEye)),
                    "truth: T_world_left_eye");
  auto right_pose =
      module.output("right_pose", hc::transformation<double>(4, 4).in(to_from(kWorld, kRightEye)),
                    "truth: T_world_right_eye");
  auto ball_place = module.output("ball", hc::position<double>(6).in(kWorld),
                                  "truth: the ball's middle [m] and velocity [m/s]");
  auto ball_seen = module.output("ball_seen", hc::table<double>(),
                                 "truth, 1 x 4: u, v, radius of the ball in the left picture [px], "
                                 "share of it that is seen");
  auto plates = module.output("plates", hc::table<double>(),
                              "truth, a row each: kind (0 aruco, 1 apriltag, 2 colour), id, side "
                              "[m], x y z [m] and qx qy qz qw in the world");
  auto board = module.output("board", hc::string(), "truth: what stands on the board");

  auto seed = module.parameter("seed", 1, "", "of the world, the ball and the noise",
                               {.least = 0, .most = 1e9, .fixed = true});
  auto rate = module.parameter("rate", 20.0, "Hz", "pairs of pictures a second",
                               {.least = 0.1, .most = 1000, .fixed = true});
  auto count = module.parameter("count", 0, "", "pairs to give, 0: all", {.least = 0});
  auto paced = module.parameter("paced", true, "",
                                "in real time; false: as fast as they are drawn and gazes come",
                                {.fixed = true});
  auto start = module.parameter("start", 0, "ns", "time of the first picture, 0: now",
                                {.least = 0, .fixed = true});
  auto width = module.parameter("width", 800, "px", "of the pictures",
                                {.least = 16, .most = 8192, .fixed = true});
  auto height = module.parameter("height", 600, "px", "of the pictures",
                                 {.least = 16, .most = 8192, .fixed = true});
  auto focal = module.parameter("focal", 600.0, "px", "focal length of the eyes",
                                {.least = 10, .most = 1e5, .fixed = true});
  auto baseline = module.parameter("baseline", 0.1, "m", "distance of the eyes",
                                   {.least = 0, .most = 1, .fixed = true});
  auto noise = module.parameter("noise", 2.0, "", "standard deviation of the noise, of 255",
                                {.least = 0, .most = 40});
  auto blur = module.parameter("blur", 0.0, "px", "standard deviation of the blur",
                               {.least = 0, .most = 20});
  auto exposure =
      module.parameter("exposure", 1.0, "", "1 is as it should be", {.least = 0, .most = 10});
  auto latency = module.parameter("latency", 0.0, "s", "from taking a picture to giving it",
                                  {.least = 0, .most = 2});
  auto swapped = module.parameter("swapped", false, "", "the cables of the eyes are mixed up");
  auto zero_pan = module.parameter("zero_pan", 0.0, "rad", "where the eyes look with the unit at 0",
                                   {.least = -0.5, .most = 0.5, .fixed = true});
  auto zero_tilt = module.parameter("zero_tilt", 0.0, "rad", "the same of tilt",
                                    {.least = -0.5, .most = 0.5, .fixed = true});
  auto offset_roll = module.parameter("offset_roll", 0.0, "rad", "of the right eye, about its z",
                                      {.least = -0.5, .most = 0.5, .fixed = true});
  auto offset_pitch = module.parameter("offset_pitch", 0.0, "rad", "of the right eye, about its x",
                                       {.least = -0.5, .most = 0.5, .fixed = true});
  auto offset_yaw = module.parameter("offset_yaw", 0.0, "rad", "of the right eye, about its y",
                                     {.least = -0.5, .most = 0.5, .fixed = true});
  auto ball_motion =
      module.parameter("ball", "roll", "", "what the ball does",
                       {.choices = {"still", "roll", "bounce", "hide", "gone"}, .fixed = true});
  auto ball_speed = module.parameter("ball_speed", 0.349, "rad/s", "as seen from the robot",
                                     {.least = 0, .most = 10, .fixed = true});
  auto ball_hidden = module.parameter("ball_hidden", 2.0, "s", "rest behind the screen",
                                      {.least = 0, .most = 60, .fixed = true});
  auto text = module.parameter("text", "HELLO ROBOT", "", "what stands on the board");

  std::unique_ptr<hc::graphics::Renderer> renderer;
  std::unique_ptr<World> world;
  std::optional<Ball> ball;
  std::optional<Sensor> left_sensor, right_sensor;
  hc::graphics::PinholeCamera camera;
  Head head;
  hc::frames::Track gazes{hc::frames::Memory{}};
  std::string written;
  std::int64_t first_time = 0, frame = 0, sample = 0;
  struct Waiting {
    std::int64_t due;
    std::function<void()> send;
  };
  std::deque<Waiting> waiting;

  auto write = [&](const std::string& what) {
    written = what;
    world->write(written);
    auto truth = hc::string(written);
    truth.header.time = module.now();
    board.send(truth);
  };
  std::string last_parameter;

  module.on_start([&] {
    renderer = hc::value_or_end(hc::graphics::Renderer::make());
    const auto number = static_cast<std::uint64_t>(*seed);
    written = last_parameter = *text;
    world = std::make_unique<World>(*renderer, number, written);
    ball.emplace(BallMotion{*ball_motion, *ball_speed, *ball_hidden, number});
    left_sensor.emplace(2 * number);
    right_sensor.emplace(2 * number + 1);
    camera.width = static_cast<int>(*width);
    camera.height = static_cast<int>(*height);
    camera.fx = camera.fy = *focal;
    camera.cx = (camera.width - 1) / 2.0;
    camera.cy = (camera.height - 1) / 2.0;
    head = {*baseline, {*zero_pan, *zero_tilt, *offset_roll, *offset_pitch, *offset_yaw}};
    first_time = *start > 0 ? *start : module.now();
  });
  module.on(gaze, [&](const auto& message) {
    if (message.header.time <= 0) return;
    hc::frames::Pose pose;
    pose.q = hc::value_or_end(hc::rotation_of(message));
    gazes.add(message.header.time, pose);
  });
  module.on(writing, [&](const auto& message) { write(std::string(message.characters())); });

  /// Where the head is in the world at a time; the nearest that is known.
  auto head_at = [&](std::int64_t time) {
    Eigen::Isometry3d T_world_head(Eigen::Translation3d(0, 0, kNeckHeight));
    if (gazes.empty()) return T_world_head;
    const auto known = gazes.known();
    return T_world_head * gazes.at(std::clamp(time, known.first, known.last)).transformation();
  };

  auto send_pose = [&](auto& output, const Eigen::Isometry3d& pose, std::int64_t time) {
    if (!output.linked()) return;
    auto draft = output.loan(4, 4);
    draft.header.time = time;
    auto numbers = draft.matrix().numbers();
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        numbers[static_cast<std::size_t>(4 * row + column)] = pose.matrix()(row, column);
    output.send(std::move(draft));
  };

  auto send_picture =
      [&](auto& output, std::optional<Sensor>& sensor, const Eigen::Isometry3d& T_world_eye,
          const std::vector<hc::graphics::Item>& items, std::int64_t time, cv::Mat* metres) {
        if (!output.linked() && metres == nullptr) return;  // drawing is most of the work
        auto draft = output.loan(camera.width, camera.height);
        draft.header.time = time;
        cv::Mat rgb = hc::value_or_end(hc::as_mat(draft));
        auto light = world->light();
        light.exposure = static_cast<float>(*exposure);
        if (auto drawn = renderer->draw(items, camera, T_world_eye, light, rgb, metres); !drawn)
          throw hc::ModuleError(drawn.error());
        sensor->apply(rgb, *blur, *noise, static_cast<std::uint64_t>(frame));
        auto shared = std::make_shared<decltype(draft)>(std::move(draft));
        waiting.push_back({time + static_cast<std::int64_t>(*latency * 1e9),
                           [shared, &output] { output.send(std::move(*shared)); }});
      };

  auto send_truth = [&](double t, std::int64_t time, const Eigen::Isometry3d& T_world_head,
                        const Eigen::Isometry3d& T_world_left) {
    send_pose(head_pose, T_world_head, time);
    send_pose(left_pose, T_world_left, time);
    send_pose(right_pose, T_world_head * head.right_eye(), time);
    const auto state = ball->at(t);
    if (ball_place.linked()) {
      auto draft = ball_place.loan(1, 1);
      draft.header.time = time;
      Eigen::Map<Eigen::Vector3d>(draft.matrix().numbers().data()) = state.position;
      Eigen::Map<Eigen::Vector3d>(draft.matrix().numbers().data() + 3) = state.velocity;
      ball_place.send(std::move(draft));
    }
    const Eigen::Vector3d p_left = T_world_left.inverse() * state.position;
    double share = 0, radius = 0;
    Eigen::Vector2d pixel(0, 0);
    if (p_left.z() > camera.near) {
      pixel = camera.project(p_left);
      radius = camera.fx * kBallRadius / p_left.z();
      const bool is_inside = pixel.x() > -0.5 && pixel.x() < camera.width - 0.5 &&
                             pixel.y() > -0.5 && pixel.y() < camera.height - 0.5;
      if (is_inside && *ball_motion != "gone")
        share = share_seen(state.position, T_world_left.translation());
    }
    auto seen = hc::table({pixel.x(), pixel.y(), radius, share});
    seen.header.time = time;
    ball_seen.send(seen);
    const auto each_second = std::max<std::int64_t>(1, std::llround(*rate));
    if (frame % each_second != 0) return;
    auto truth = hc::string(written);
    truth.header.time = time;
    board.send(truth);
    const auto& all = world->plates();
    auto draft = plates.loan(10, static_cast<std::int32_t>(all.size()));
    draft.header.time = time;
    auto numbers = draft.matrix().numbers();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& plate = all[i];
      const double kind = plate.kind == "aruco" ? 0 : plate.kind == "apriltag" ? 1 : 2;
      const Eigen::Vector3d p = plate.T_world_plate.translation();
      const Eigen::Quaterniond q(plate.T_world_plate.linear());
      const double row[] = {
          kind, double(plate.id), plate.side, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
      std::copy(std::begin(row), std::end(row),
                numbers.begin() + static_cast<std::ptrdiff_t>(10 * i));
    }
    plates.send(std::move(draft));
  };

  auto send_sound = [&](std::int64_t until, const Eigen::Isometry3d& T_world_head) {
    const auto end = (until - first_time) * kSoundRate / 1'000'000'000;
    if (end <= sample) return;
    if (sound.linked()) {
      auto draft = sound.loan(static_cast<std::int32_t>(end - sample), 1);
      draft.header.time = first_time + period_end(sample, kSoundRate);
      for (int side : {1, -1}) {
        const double distance = (T_world_head * Head::ear(side) - kSpeakerPlace).norm();
        hear(sample, distance, draft.matrix().numbers().subspan(side > 0 ? 0 : 1), 2);
      }
      sound.send(std::move(draft));
    }
    sample = end;
  };

  auto take = [&](std::int64_t time) {
    const double t = static_cast<double>(time - first_time) * 1e-9;
    const Eigen::Isometry3d T_world_head = head_at(time);
    const Eigen::Isometry3d T_world_left = T_world_head * head.left_eye();
    const Eigen::Isometry3d T_world_right = T_world_head * head.right_eye();
    Eigen::Vector3d place = ball->at(t).position;
    if (*ball_motion == "gone") place.z() = -10;
    const auto& items = world->items(place);
    std::optional<decltype(depth.loan(1, 1))> metres;
    cv::Mat metres_mat;
    if (depth.linked()) {
      metres.emplace(depth.loan(camera.width, camera.height));
      metres->header.time = time;
      metres_mat = hc::value_or_end(hc::as_mat(*metres));
    }
    send_picture(left, left_sensor, *swapped ? T_world_right : T_world_left, items, time,
                 metres && !*swapped ? &metres_mat : nullptr);
    if (metres && !*swapped) depth.send(std::move(*metres));
    send_picture(right, right_sensor, *swapped ? T_world_left : T_world_right, items, time,
                 nullptr);
    send_truth(t, time, T_world_head, T_world_left);
    send_sound(time, T_world_head);
  };

  module.generate([&] {
    if (*paced) module.keep_rate(kTick);
    if (*text != last_parameter) write(last_parameter = *text);
    const std::int64_t now = module.now();
    while (!waiting.empty() && (!*paced || waiting.front().due <= now)) {
      waiting.front().send();
      waiting.pop_front();
    }
    if (*count > 0 && frame >= *count) return !waiting.empty();
    if (*paced) {
      // Pictures that could not be drawn in time are left out.
      const auto newest = static_cast<std::int64_t>(
          std::floor(static_cast<double>(now - first_time) * 1e-9 * *rate));
      if (newest > frame) frame = newest;
    }
    const std::int64_t time = first_time + period_end(frame, *rate);
    if (*paced && time > now) return true;
    // The gaze is known a moment later.
    const bool is_known = gazes.empty() || gazes.known().last >= time;
    if (*paced && !is_known && now - time < std::chrono::nanoseconds(kGazeLate).count())
      return true;
    take(time);
    ++frame;
    return true;
  });
  return module.run(argc, argv);
}
