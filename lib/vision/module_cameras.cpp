// SPDX-License-Identifier: Apache-2.0
#include <vision/module_cameras.h>

#include <utility>

#include <hc/base/format.h>

namespace hc::vision {
namespace {

constexpr std::size_t kMostWaiting = 4;

}  // namespace

void AssumedCameras::say(const std::string& what) {
  if (std::exchange(has_said_, true)) return;
  module_.log("assumed: " + what + "; " + wrong_ + ": " + remedy_);
}

double AssumedCameras::focal(double known, int width, std::optional<double> baseline) {
  const bool is_known = known != kUnknownFocal;
  std::string what;
  if (!is_known) what = format("a focal length of {} px, the image's width", width);
  if (baseline)
    what += (is_known ? "" : ", and ") +
            format("eyes {:.3f} m apart, as on the default head", *baseline);
  if (!what.empty()) say(what);
  return is_known ? known : width;
}

std::optional<PairIntrinsics> PairIntrinsics::of(std::span<const double> numbers) {
  const bool is_pair =
      numbers.size() == 5 && finite(numbers) && numbers[0] > 0 && numbers[1] > 0 && numbers[4] > 0;
  if (!is_pair) return std::nullopt;
  return PairIntrinsics{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
}

ModulePair::ModulePair(Module& module, ModuleFrames& frames, std::string wrong)
    : module_(module),
      frames_(frames),
      intrinsics_(module.input("intrinsics", table(),
                               "fx, fy, cx, cy [px], baseline [m] of the rectified pair, from "
                               "rectify; where it is linked, images wait for the first")),
      focal_(module.parameter("focal", kUnknownFocal, "px",
                              "focal length without intrinsics; 0: unknown, the image's width "
                              "is assumed",
                              {.min = 0, .max = 1e6})),
      baseline_(module.parameter("baseline", 0.0, "m",
                                 "distance of the eyes without intrinsics; 0: that of the frames "
                                 "left_eye and right_eye",
                                 {.min = 0, .max = 1e3})),
      assumed_(module, std::move(wrong), "link intrinsics, or set focal and baseline") {
  module.on(intrinsics_, [this](const auto& message) {
    const auto pair = PairIntrinsics::of(message.numbers());
    if (!pair) throw BadMessage("not fx, fy, cx, cy, baseline of a pair");
    linked_ = pair;
    answer_all();
  });
}

void ModulePair::when_known(std::function<void()> handler) {
  if (!is_awaited()) {
    answer_all();
    return handler();
  }
  waiting_.push_back(std::move(handler));
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  module_.log_once("without intrinsics",
                   "images dropped: intrinsics is linked, but none have come yet");
}

void ModulePair::answer_all() {
  while (!waiting_.empty()) {
    const auto first = std::move(waiting_.front());
    waiting_.pop_front();
    first();
  }
}

PairIntrinsics ModulePair::of(int width, int height) {
  if (linked_) return *linked_;
  const bool is_set = *baseline_ > 0;
  const double baseline =
      is_set ? *baseline_ : frames_.fixed("left_eye", "right_eye").translation().norm();
  const bool is_known = is_set || frames_.are_given();
  const double focal =
      assumed_.focal(*focal_, width, is_known ? std::nullopt : std::optional(baseline));
  return {focal, focal, (width - 1) / 2.0, (height - 1) / 2.0, baseline};
}

void RectifiedMount::take(const TimedPose& pose) {
  if (pose.to == Coord::kLeftEye && pose.from == Coord::kLeftRectified)
    T_left_rectified_ = pose.T_to_from;
  else if (pose.to == Coord::kHead && pose.from == Coord::kLeftEye)
    T_head_left_ = pose.T_to_from;
}

Eigen::Isometry3d RectifiedMount::pose_in(std::string_view frame, Time time,
                                          ModuleFrames& frames) const {
  const auto pose_of = [&](std::string_view other) {
    const auto known = frames.lookup(frame, other, time);
    return known ? *known : frames.nearest(frame, other, time);
  };
  return (T_head_left_ ? pose_of("head") * *T_head_left_ : pose_of("left_eye")) * T_left_rectified_;
}

}  // namespace hc::vision
