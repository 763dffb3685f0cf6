// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/tracked_head.h>

#include <hc/base/format.h>

#include <utility>

namespace hc {

Status TrackedHead::pass(MonotonicTime now) {
  if (options_.host.empty()) return {};
  if (!tracker_) return backoff_.is_due(now) ? listen(now) : Status();
  if (!active_ || now - *active_ < options_.silence) return {};
  active_.reset();
  receives_ = false;
  log_(Level::Warning, "no packets received on UDP " + address_);
  return {};
}

Status TrackedHead::listen(MonotonicTime now) {
  auto opened =
      HeadTracker::open(options_.host, options_.port, {options_.senders, options_.silence});
  if (!opened && opened.error().code == Code::Invalid) return opened.error();
  if (!opened) {
    backoff_.fail(now);
    problem_("port in use", opened.error().detail + "; retrying");
    return {};
  }
  tracker_.emplace(std::move(*opened));
  active_ = now;
  const bool is_six = options_.host.find(':') != std::string::npos;
  address_ = hc::format(is_six ? "[{}]:{}" : "{}:{}", options_.host, tracker_->port());
  log_(Level::Info, "listening on UDP " + address_);
  return {};
}

Result<std::optional<TimedHeadPose>> TrackedHead::receive(MonotonicTime now) {
  if (!tracker_) return std::optional<TimedHeadPose>();
  auto pose = tracker_->receive(now, problem_);
  if (!pose || !*pose) return pose;
  active_ = now;
  if (!std::exchange(receives_, true)) log_(Level::Info, "receiving from the tracker");
  HeadPose& head = (*pose)->pose;
  if (std::exchange(is_first_, false) && options_.centre_first) {
    const Eigen::Vector3d angles = head.angles().array() + 0.0;  // not -0
    log_(Level::Info,
         hc::format("zero set to the first pose: roll {:.2f}, pitch {:.2f}, yaw {:.2f} rad",
                    angles.x(), angles.y(), angles.z()));
    centres_next_ = true;
  }
  if (std::exchange(centres_next_, false)) zero_ = head;
  head = head.relative_to(zero_);
  return pose;
}

}  // namespace hc
