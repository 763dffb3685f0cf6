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
  std::string bytes = to_unit_.take(time);
  const std::string answer = unit_.take(time, bytes) + unit_.pass(time);
  if (!is_silent) from_unit_.put(time, answer, faults);
  if (terminal_) terminal_->write(from_unit_.take(time));
  return bytes;
}

double SimulatedLine::pause(double time) const {
  double pause = kLook;
  for (auto due : {to_unit_.next(), from_unit_.next(), unit_.next()})
    if (due) pause = std::min(pause, *due - time);
  return pause;
}
