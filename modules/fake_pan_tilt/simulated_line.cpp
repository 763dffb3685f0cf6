// SPDX-License-Identifier: Apache-2.0
#include "simulated_line.h"

#include <algorithm>

SimulatedLine::SimulatedLine(double pan, double tilt, std::uint64_t seed)
    : unit_(pan / kStep, -tilt / kStep), to_unit_(seed), from_unit_(seed) {}

hc::Result<bool> SimulatedLine::plug(bool in) {
  if (in == terminal_.has_value()) return false;
  if (in) {
    auto opened = HC_TRY(Terminal::open());
    terminal_.emplace(std::move(opened));
  } else {
    terminal_.reset();
  }
  to_unit_.clear();
  from_unit_.clear();
  return true;
}

std::string SimulatedLine::serve(double time, const Wire::Faults& faults, bool is_silent) {
  if (terminal_)
    to_unit_.put(time, terminal_->read(), {.bytes_per_second = faults.bytes_per_second});
  std::string bytes;
  // A call may be late; a unit is not.
  for (auto due = unit_due(); due && *due <= time; due = unit_due()) {
    served_ = std::max(served_, *due);
    const std::string arrived = to_unit_.take(served_);
    const std::string answer = unit_.take(served_, arrived);
    if (!is_silent) from_unit_.put(served_, answer, faults);
    bytes += arrived;
  }
  if (terminal_) terminal_->write(from_unit_.take(time));
  return bytes;
}

std::optional<double> SimulatedLine::unit_due() const {
  const auto byte = to_unit_.next(), own = unit_.next();
  return byte && own ? std::min(byte, own) : byte ? byte : own;
}

double SimulatedLine::pause(double time) const {
  double pause = kLook;
  for (auto due : {to_unit_.next(), from_unit_.next(), unit_.next()})
    if (due) pause = std::min(pause, *due - time);
  return pause;
}
