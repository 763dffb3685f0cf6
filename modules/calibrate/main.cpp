// SPDX-License-Identifier: Apache-2.0
// A task: turns the head a little to all sides to calibrate the mounting of its eyes.
#include "calibrate.h"

#include <cmath>
#include <filesystem>
#include <future>
#include <optional>
#include <stop_token>
#include <utility>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>
#include <opencv2/imgproc.hpp>

namespace {

using hc::gaze::Angles;

constexpr std::int64_t kSilent = 1'000'000'000;  // without a pair for longer: disconnected [ns]
constexpr double kNear = 0.004;                  // tolerance of a commanded pose [rad]
constexpr std::int64_t kRests = 300'000'000;     // time in tolerance until at rest [ns]

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"calibrate", "Finds how a head's eyes are mounted, by turning it."};
  auto left = module.input("left", hc::rgb_image().in(hc::Coord::kLeftImage),
                           "image of the left camera");
  auto right = module.input("right", hc::rgb_image().in(hc::Coord::kRightImage),
                            "of the right one");
  auto command = module.output("command", hc::rotation().in(hc::Coord::kGaze),
                               "commanded head orientation: roll 0, tilt, pan [rad]");
  auto bid = module.output("bid", hc::table(), "salience while it looks, else 0");
  auto result = module.output("result", hc::table().of(1, 7),
                              "eyes swapped 0/1, pan and tilt of the left eye with the unit "
                              "at 0, roll, pitch, yaw of the right eye to the left one [rad], "
                              "distance from epipolar lines, RMS [px]; once a second");
  auto file = module.parameter(
      "calibration_file", "", "",
      "file of stereo_calibration: the result is added to it, and read from it if it has one",
      {.positional = true, .fixed = true});
  auto turn = module.parameter("turn", 0.28, "rad", "how far the head turns to each side",
                               {.min = 0.05, .max = 0.6, .fixed = true});
  auto salience = module.parameter("salience", 0.9, "", "of the bid", {.min = 0, .max = 1});
  auto focal = module.parameter("focal", 600.0, "px", "focal length of the eyes, without a file",
                                {.min = 1, .fixed = true});
  auto timeout =
      module.parameter("timeout", 5.0, "s", "to wait for the head to rest where it is sent",
                       {.min = 0.5, .max = 600});
  auto pause = module.parameter("pause", 30.0, "s", "after a failed attempt", {.min = 0});
  auto tries = module.parameter("tries", 3, "", "failed attempts until it gives up", {.min = 1});
  hc::ModuleFrames frames{module};

  std::vector<HeadView> views;
  std::vector<Angles> poses;  // to visit
  std::optional<hc::gaze::Eyes> mounted;
  std::int64_t rests_from = 0;                              // 0: moving [ns]
  hc::vision::StereoCalibration cameras;                    // set once the images' size is known
  std::future<hc::Result<hc::gaze::HeadCalibration>> work;  // valid while computing
  std::stop_source stop;
  std::optional<hc::gaze::HeadCalibration> found;
  bool is_done = false;
  std::int64_t last_pair = 0;     // last images of both eyes with a known head pose [ns]
  std::int64_t sent = 0;          // when the current pose was first commanded; 0: not yet [ns]
  std::int64_t paused_until = 0;  // [ns]
  std::int64_t tried = 0;         // failed attempts

  auto publish = [&] {
    const auto numbers = found->numbers();
    result.send(std::span(numbers));
  };
  std::string how_found;  // for the final log line
  auto finish = [&](const hc::gaze::HeadCalibration& calibration, const std::string& how) {
    is_done = true;
    how_found = how.empty() ? "by turning the head" : "from " + *file;
    found = calibration;
    publish();
    constexpr double kDegrees = 180 / M_PI;
    module.log(
        hc::format("{}cameras {}; gaze offset pan {:.2f}°, tilt {:.2f}°; right-to-left rotation "
                   "roll {:.2f}°, pitch {:.2f}°, yaw {:.2f}°",
                   how, found->swapped ? "swapped" : "not swapped", found->zero.pan * kDegrees,
                   found->zero.tilt * kDegrees, found->offset.z() * kDegrees,
                   found->offset.x() * kDegrees, found->offset.y() * kDegrees));
  };
  auto fail = [&](const std::string& why) {
    views.clear();
    sent = rests_from = 0;
    is_done = ++tried >= *tries;
    paused_until = module.now() + hc::duration(*pause).count();
    module.log("not calibrated: " + why + (is_done ? "; giving up" : "; retrying"));
  };
  /// Takes the result of the computation.
  auto take = [&] {
    const auto calibration = work.get();
    if (!calibration) return fail(calibration.error().detail);
    finish(*calibration, "");
    if (file->empty()) return;
    hc::vision::turn(cameras, calibration->R_left_right());
    const auto numbers = calibration->numbers();
    cameras.head.assign(numbers.begin(), numbers.end());
    if (auto written = hc::vision::write_calibration(*file, cameras); !written)
      module.log(written.error().detail);
  };

  module.on_start([&] {
    mounted.emplace(frames.fixed("head", "left_eye"), frames.fixed("head", "right_eye"));
    const double t = *turn;
    poses = {{0, 0},         {t, 0},           {-t, 0},         {0, t},         {0, -t},
             {t / 2, t / 2}, {-t / 2, -t / 2}, {t / 2, -t / 2}, {-t / 2, t / 2}};
    if (file->empty() || !std::filesystem::exists(*file)) return;
    cameras = hc::value_or_end(hc::vision::read_calibration(*file));
    if (!cameras.head.empty())
      finish(hc::value_or_end(hc::gaze::HeadCalibration::of(cameras.head)), "from " + *file + ": ");
  });
  /// Handles a pair of images and the head's pose at its time.
  auto look = [&](std::int64_t time, const Angles& measured, const hc::Message& one,
                  const hc::Message& other) {
    last_pair = module.now();
    if (is_done || work.valid()) return;
    const auto& wanted = poses[views.size()];
    const bool is_there = std::abs(measured.pan - wanted.pan) < kNear &&
                          std::abs(measured.tilt - wanted.tilt) < kNear;
    if (!is_there)
      rests_from = 0;
    else if (rests_from == 0)
      rests_from = time;
    if (!is_there || time < rests_from + kRests) return;
    HeadView view;
    view.unit = measured;
    cv::cvtColor(hc::value_or_drop(hc::as_mat(one)), view.first, cv::COLOR_RGB2GRAY);
    cv::cvtColor(hc::value_or_drop(hc::as_mat(other)), view.second, cv::COLOR_RGB2GRAY);
    if (view.first.size() != view.second.size() ||
        (!views.empty() && view.first.size() != views[0].first.size()))
      throw hc::BadMessage("the images have different sizes");
    if (cameras.M1(0, 0) == 0)
      cameras = hc::vision::ideal_pair(view.first.size(), *focal, mounted->baseline());
    if (cameras.size.area() == 0) cameras.size = view.first.size();
    views.push_back(std::move(view));
    sent = rests_from = 0;
    if (views.size() < poses.size()) return;
    mounted->set_baseline(cameras.baseline());
    work = std::async(std::launch::async, calibrate, std::exchange(views, {}), cameras, *mounted,
                      stop.get_token());
  };
  module.on(hc::together(left, right), [&](const auto& one, const auto& other) {
    const std::int64_t time = one.header.time;
    frames.when_known("robot", "head", time, [&, time, one, other](const auto& T_robot_head) {
      if (!T_robot_head) return;
      look(time, hc::gaze::angles_of(Eigen::Quaterniond(T_robot_head->linear())), one, other);
    });
  });
  module.every(std::chrono::milliseconds(50), [&] {
    using std::chrono_literals::operator""ms;
    const std::int64_t now = module.now();
    if (work.valid() && work.wait_for(0ms) == std::future_status::ready) take();
    // Bids for the head only while images of both eyes arrive with a known head pose.
    const bool sees = now - last_pair < kSilent;
    const bool wants = !is_done && now >= paused_until && (sees || work.valid());
    bid.send({wants ? *salience : 0.0}, now);
    if (!wants) {
      sent = 0;
      return;
    }
    const auto& wanted = work.valid() ? poses.back() : poses[views.size()];
    if (sent == 0) sent = now;
    if (!work.valid() && hc::seconds(now - sent) > *timeout)
      return fail("the head did not come to rest at the commanded pose");
    command.send({0.0, wanted.tilt, wanted.pan}, now);
  });
  module.every(std::chrono::seconds(1), [&] {
    if (found) publish();
  });
  // When the images end, the result is still published; when asked to stop, it is discarded.
  module.on_end([&] {
    if (work.valid()) take();
  });
  const int status = module.run(argc, argv);
  stop.request_stop();
  if (found)
    module.log("eye mounting calibrated " + how_found, hc::Level::Result);
  else if (tried > 0)
    module.log("eye mounting not found", hc::Level::Result);
  return status;
}
