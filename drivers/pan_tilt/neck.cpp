// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/neck.h>

#include <hc/base/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hc::pan_tilt {
namespace {

constexpr std::size_t kMostRemarks = 10;  // logged per fault, since garbage may look like remarks

}  // namespace

using Phase = Conversation::Phase;

void Neck::set(const NeckSettings& settings) {
  conversation_.set_pace(settings.speed, settings.acceleration);
  conversation_.set_hold(settings.hold);
  if (settings.device != settings_.device) use(settings.device, true);
  set_baud(settings.baud);
  settings_ = settings;
}

void Neck::use(std::string_view device, bool stays) {
  if (device == device_) return;
  if (serial_) close({Code::Stopped, device.empty() ? "removed" : "closed"});
  device_ = device;
  stays_ = stays;
  backoff_.reset();
  if (!device_.empty()) open();
}

void Neck::set_baud(int baud) {
  if (std::exchange(baud_, baud) == baud || device_.empty()) return;
  if (serial_) close({Code::Stopped, "reopening"});
  backoff_.reset();
  open();
}

void Neck::open() {
  const auto now = clock_.monotonic();
  auto opened = Serial::open(device_, baud_);
  if (!opened) {
    log_fault(opened.error());
    if (!stays_) device_.clear();
    return backoff_.fail(now);
  }
  serial_ = std::move(*opened);
  constexpr double kBits = 10;  // per byte on the line
  conversation_.set_line(baud_ / kBits);
  conversation_.begin(now);
  work();
}

void Neck::close(const Error& why) {
  log_fault(why);
  serial_.reset();
  conversation_.end();
  if (why.code == Code::Closed && !stays_) device_.clear();
  backoff_.fail(clock_.monotonic());
}

void Neck::log_fault(const Error& error) {
  well_since_ = MonotonicTime::max();
  const bool is_garbage = error.code == Code::Malformed || error.code == Code::TooLarge;
  if (faults_.insert(is_garbage ? "garbage" : error.detail).second)
    log_(Level::Warning, device_ + ": " + error.detail);
}

void Neck::read() {
  std::array<char, 512> room = {};
  while (serial_) {
    auto bytes = serial_->read(room);
    if (!bytes) {
      close(bytes.error());
      break;
    }
    if (bytes->empty()) break;
    // After the read: where this process has waited, the time is late, never before the arrival.
    conversation_.take(clock_.monotonic(), *bytes);
    work();
  }
  if (const auto gaze = conversation_.gaze()) seen_(*gaze);
}

/// Executes the conversation's results.
void Neck::work() {
  if (auto fault = conversation_.fault()) log_fault(*fault);
  if (auto remark = conversation_.remark();
      !remark.empty() && remarks_.size() < kMostRemarks && remarks_.insert(remark).second)
    log_(Level::Warning, device_ + ": " + remark);
  if (conversation_.phase() == Phase::Lost) return close({Code::Stopped, "reopening"});
  if (conversation_.phase() == Phase::Ready && well_since_ == MonotonicTime::max())
    well_since_ = clock_.monotonic();
  // The clock is read here, since this process may have waited since it was read before.
  if (const auto bytes = conversation_.bytes(clock_.monotonic()); !bytes.empty() && serial_)
    if (auto written = serial_->write(bytes); !written) close(written.error());
}

void Neck::pass(const NeckSettings& settings) {
  set(settings);
  if (!serial_ && !device_.empty() && backoff_.is_due(clock_.monotonic())) open();
  const auto now = clock_.monotonic();
  read();  // first, since an answer that has arrived by now is not overdue
  conversation_.pass(now);
  work();
  if (conversation_.phase() != Phase::Ready) return;
  if (!was_ready_ || now - well_since_ >= kSettled) backoff_.reset();
  if (was_ready_ && (faults_.empty() || now - well_since_ < kSettled)) return;
  log_(Level::Info, device_ + ": " + (was_ready_ ? "reconnected" : conversation_.character()));
  was_ready_ = true;
  faults_.clear();
  remarks_.clear();
}

void Neck::look() {
  conversation_.look(clock_.monotonic());
  work();
}

void Neck::command(Time wall, const NeckCommand& command) {
  const auto now = clock_.monotonic();
  if (command.time == Time()) return problem_("without a time", "command dropped: no time");
  const double old = seconds(wall - command.time);
  if (std::abs(old) > settings_.age)
    return problem_("stale", hc::format("command dropped: {:.3f} s {}", std::abs(old),
                                        old > 0 ? "old" : "in the future"));
  if (std::exchange(mode_, command.mode) != command.mode) turn_ = Turn<std::int32_t>(kTurn);
  if (!turn_.take(command.source, now))
    return problem_("second source",
                    hc::format("command of source {} dropped: source {} is in control",
                               command.source, *turn_.holder(now)));
  const bool is_taken = conversation_.command(now, command.pan, command.tilt,
                                              duration(settings_.age - std::max(old, 0.0)));
  work();
  if (!is_taken) problem_("no unit", "command dropped: pan-tilt unit not connected");
}

void Neck::set_focus(std::int32_t mode) {
  if (std::exchange(focus_, mode) == mode) return;
  conversation_.forget();
  if (mode == 0) conversation_.halt(clock_.monotonic());
  work();
}

void Neck::leave() {
  if (serial_) static_cast<void>(serial_->write(conversation_.last_words()));
  serial_.reset();
  conversation_.end();
}

}  // namespace hc::pan_tilt
