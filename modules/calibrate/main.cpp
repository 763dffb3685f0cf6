// SPDX-License-Identifier: Apache-2.0
// A task: turns the head a little to all sides, and finds how its eyes sit on it.
#include "calibrate.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include <hc/adapter/opencv.h>
#include <hc/adapter/pose.h>
#include <hc/node/module.h>
#include <opencv2/imgproc.hpp>

namespace {

using hc::gaze::Angles;

constexpr std::int32_t kLeftImage = 7, kRightImage = 8, kGaze = 13;
constexpr double kNear = 0.004;               // of where it was sent: the unit stands there [rad]
constexpr std::int64_t kRests = 300'000'000;  // so long, then it is at rest [ns]

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"calibrate", "Finds how a head's eyes sit on it, by turning it."};
  auto left = module.input("left", hc::rgb_image<std::uint8_t>().in(kLeftImage),
                           "left eye, as it is plugged in");
  auto right = module.input("right", hc::rgb_image<std::uint8_t>().in(kRightImage), "right eye");
  auto report = module.input("gaze", hc::rotation<double>().in(kGaze), "how the head stands");
  auto command = module.output("command", hc::rotation<double>().in(kGaze), "how it is to stand");
  auto bid = module.output("bid", hc::table<double>(), "salience until it is done, then 0");
  auto result = module.output("result", hc::table<double>(),
                              "1 x 7: eyes swapped 0/1, pan and tilt of the left eye with the unit "
                              "at 0, roll, pitch, yaw of the right eye to the left one [rad], "
                              "distance from epipolar lines, RMS [px]");
  auto turn = module.parameter("turn", 0.28, "rad", "how far the head turns to each side",
                               {.least = 0.05, .most = 0.6});
  auto salience = module.parameter("salience", 0.9, "", "of the bid", {.least = 0, .most = 1});
  auto focal = module.parameter("focal", 600.0, "px", "focal length of the eyes", {.least = 1});
  auto cx = module.parameter("cx", 399.5, "px", "middle of the pictures");
  auto cy = module.parameter("cy", 299.5, "px", "middle of the pictures");
  auto baseline = module.parameter("baseline", 0.1, "m", "distance of the eyes", {.least = 0.001});
  auto forward = module.parameter("forward", 0.06, "m", "of the eyes from the unit's axes");
  auto up = module.parameter("up", 0.05, "m", "of the eyes from the unit's axes");

  std::vector<HeadView> views;
  std::vector<Angles> stands;
  std::int64_t rests_from = 0;  // 0: it moves [ns]
  Angles last;
  bool is_done = false;

  module.on_start([&] {
    const double t = *turn;
    stands = {{0, 0},         {t, 0},           {-t, 0},         {0, t},         {0, -t},
              {t / 2, t / 2}, {-t / 2, -t / 2}, {t / 2, -t / 2}, {-t / 2, t / 2}};
  });
  auto finish = [&] {
    is_done = true;
    auto found = calibrate(views, {*focal, *cx, *cy}, {*forward, 0, *up}, *baseline);
    views.clear();
    if (!found) return module.log("not calibrated: " + found.error().detail);
    auto message =
        hc::table({found->swapped ? 1.0 : 0.0, found->zero.pan, found->zero.tilt,
                   found->offset_roll, found->offset_pitch, found->offset_yaw, found->rms});
    result.send(message);
    constexpr double kDegrees = 180 / M_PI;
    char line[200];
    std::snprintf(
        line, sizeof line,
        "eyes %s; they look to pan %.2f°, tilt %.2f° with the unit at 0; the right one is "
        "off by roll %.2f°, pitch %.2f°, yaw %.2f°",
        found->swapped ? "swapped" : "as plugged in", found->zero.pan * kDegrees,
        found->zero.tilt * kDegrees, found->offset_roll * kDegrees, found->offset_pitch * kDegrees,
        found->offset_yaw * kDegrees);
    module.log(line);
  };

  module.on(report, [&](const auto& message) {
    if (is_done) return;
    last = hc::gaze::angles_of(hc::value_or_end(hc::rotation_of(message)));
    const auto& wanted = stands[views.size()];
    const bool is_there =
        std::abs(last.pan - wanted.pan) < kNear && std::abs(last.tilt - wanted.tilt) < kNear;
    if (!is_there)
      rests_from = 0;
    else if (rests_from == 0)
      rests_from = message.header.time;
  });
  module.on(hc::together(left, right), [&](const auto& one, const auto& other) {
    if (is_done || rests_from == 0 || one.header.time < rests_from + kRests) return;
    HeadView view;
    view.unit = last;
    cv::cvtColor(hc::value_or_end(hc::as_mat(one)), view.first, cv::COLOR_RGB2GRAY);
    cv::cvtColor(hc::value_or_end(hc::as_mat(other)), view.second, cv::COLOR_RGB2GRAY);
    views.push_back(std::move(view));
    rests_from = 0;
    if (views.size() == stands.size()) finish();
  });
  module.every(std::chrono::milliseconds(50), [&] {
    const std::int64_t now = module.now();
    auto message = hc::table({is_done ? 0.0 : *salience});
    message.header.time = now;
    bid.send(message);
    if (is_done) return;
    const auto& wanted = stands[views.size()];
    auto draft = command.loan(1, 1);
    draft.header.time = now;
    auto numbers = draft.matrix().numbers();
    numbers[0] = 0;
    numbers[1] = wanted.tilt;
    numbers[2] = wanted.pan;
    command.send(std::move(draft));
  });
  return module.run(argc, argv);
}
