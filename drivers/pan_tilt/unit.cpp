// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/unit.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <hc/base/text.h>

namespace hc::pan_tilt {
namespace {

constexpr std::size_t kMostWaiting = 256;
constexpr Pace kPace = {1000, 2000, 1000};
constexpr const char* kDone = "*\r\n";

std::string refusal(const std::string& why) {
  return "! " + why + "\r\n";
}
std::string illegal() {
  return refusal("Illegal command entered");
}
bool is_delimiter(char byte) {
  return byte == ' ' || byte == '\r' || byte == '\n';
}
int rounded(double value) {
  return static_cast<int>(std::lround(value));
}

/// The value after a command's letters: none, or up to six digits.
bool read_value(std::string_view text, std::optional<int>& value) {
  if (text.empty()) return true;
  if (text[0] == '+') text.remove_prefix(1);
  if (text.empty() || text.size() > 7) return false;
  int number = 0;
  if (!read_number(text, number)) return false;
  value = number;
  return true;
}

}  // namespace

Unit::Unit(double pan, double tilt)
    : axes_{Axis{"Pan", 'P', -3090, 3090, Motion(std::clamp(pan, -3090.0, 3090.0), kPace)},
            Axis{"Tilt", 'T', -907, 604, Motion(std::clamp(tilt, -907.0, 604.0), kPace)}} {}

double Unit::still() const {
  return std::max(axes_[0].motion.end(), axes_[1].motion.end());
}

std::optional<double> Unit::next() const {
  std::optional<double> soonest;
  if (busy_ != Busy::No) soonest = still();
  for (const Axis& axis : axes_)
    if (axis.runs_into_limit) soonest = std::min(soonest.value_or(1e300), axis.motion.end());
  return soonest;
}

std::string Unit::take(double time, std::string_view bytes) {
  std::string said = pass(time);
  for (char byte : bytes) {
    if (!skips_ && waiting_.size() == kMostWaiting) {
      const auto last = std::find_if(waiting_.rbegin(), waiting_.rend(), is_delimiter);
      waiting_.erase(last.base(), waiting_.end());
      skips_ = true;
    }
    if (skips_) {
      skips_ = !is_delimiter(byte);
      continue;
    }
    waiting_ += byte;
    obey(time);
  }
  return said + std::exchange(said_, {});
}

std::string Unit::pass(double time) {
  for (Axis& axis : axes_) {
    if (!axis.runs_into_limit || time < axis.motion.end()) continue;
    axis.runs_into_limit = false;
    said_ += std::string("!") + axis.letter;
  }
  while (busy_ != Busy::No && time >= still()) {
    said_ += busy_ == Busy::Resets ? "!T!T!P!P*\r\n" : kDone;
    busy_ = Busy::No;
    obey(time);
  }
  return std::exchange(said_, {});
}

/// Executes the complete commands.
void Unit::obey(double time) {
  while (busy_ == Busy::No) {
    const auto end = std::find_if(waiting_.begin(), waiting_.end(), is_delimiter);
    if (end == waiting_.end()) return;
    std::string words(waiting_.begin(), end);
    if (echoes_) said_ += words + *end;
    waiting_.erase(waiting_.begin(), end + 1);
    for (char& letter : words)
      letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    if (!words.empty()) said_ += answer(time, words);
  }
}

std::string Unit::answer(double time, std::string_view words) {
  constexpr std::string_view kProperties = "POSDABULRNX";
  const bool is_of_axis = words.size() >= 2 && (words[0] == 'P' || words[0] == 'T') &&
                          kProperties.find(words[1]) != std::string_view::npos;
  if (!is_of_axis) return of_unit(time, words);
  std::optional<int> value;
  if (!read_value(words.substr(2), value)) return illegal();
  Axis& axis = axes_[words[0] == 'P' ? 0 : 1];
  return value ? set(time, axis, words[1], *value) : ask(time, axis, words[1]);
}

std::string Unit::set(double time, Axis& axis, char property, int value) {
  Pace pace = axis.motion.pace();
  const std::string name = axis.name;
  switch (property) {
    case 'P':
      return go(time, axis, value);
    case 'O':
      return go(time, axis, rounded(axis.motion.at(time).position) + value);
    case 'S':
      return set_speed(time, axis, value);
    case 'D':
      return set_speed(time, axis, rounded(axis.motion.at(time).speed) + value);
    case 'A':
      if (value < 1 || value > 100'000) return refusal(name + " acceleration is out of range");
      pace.acceleration = value;
      break;
    case 'B':
      if (value < axis.lower || value > axis.upper)
        return refusal(name + " base speed is out of range");
      pace.base = value;
      break;
    case 'U':
      if (value < axis.lower || value > 2902) return refusal(name + " upper speed is out of range");
      axis.upper = value;
      return kDone;
    case 'L':
      if (value < 31 || value > axis.upper) return refusal(name + " lower speed is out of range");
      axis.lower = value;
      return kDone;
    default:
      return illegal();
  }
  axis.motion.set_pace(time, pace);
  return kDone;
}

std::string Unit::ask(double time, const Axis& axis, char property) const {
  const std::string name = axis.name;
  const auto number = [](double value) { return std::to_string(rounded(value)); };
  constexpr const char* kSpeedUnit = " positions/sec";
  switch (property) {
    case 'P':
      return result("Current " + name + " position is ", number(axis.motion.at(time).position));
    case 'O':
      return result("Target " + name + " position is ", number(axis.motion.target()));
    case 'S':
      return result("Target " + name + " speed is ", number(axis.speed), kSpeedUnit);
    case 'D':
      return result("Current " + name + " speed is ", number(axis.motion.at(time).speed),
                    kSpeedUnit);
    case 'A':
      return result(name + " acceleration is ", number(axis.motion.pace().acceleration),
                    " positions/sec^2");
    case 'B':
      return result(name + " base speed is ", number(axis.motion.pace().base), kSpeedUnit);
    case 'U':
      return result("Maximum " + name + " speed is ", number(axis.upper), kSpeedUnit);
    case 'L':
      return result("Minimum " + name + " speed is ", number(axis.lower), kSpeedUnit);
    case 'R':
      return result("", "185.1428", " seconds arc per position");
    case 'N':
      return result("Minimum " + name + " position is ", number(axis.least));
    default:
      return result("Maximum " + name + " position is ", number(axis.most));
  }
}

std::string Unit::of_unit(double time, std::string_view words) {
  const auto turn = [](bool& state, bool value) {
    state = value;
    return std::string(kDone);
  };
  if (words == "I") return kDone;
  if (words == "A") {
    if (time >= still()) return kDone;
    busy_ = Busy::Awaits;
    return {};
  }
  if (words == "R") {
    for (Axis& axis : axes_) {
      axis.runs_into_limit = false;
      axis.motion.go(time, 0);
    }
    busy_ = Busy::Resets;
    return {};
  }
  if (words == "H" || words == "HP" || words == "HT") {
    for (Axis& axis : axes_) {
      if (words.size() == 2 && words[1] != axis.letter) continue;
      axis.runs_into_limit = false;
      axis.motion.halt(time);
    }
    return kDone;
  }
  if (words == "CI" || words == "CV") return turn(controls_speed_, words == "CV");
  if (words == "LE" || words == "LD") return turn(limits_, words == "LE");
  if (words == "EE" || words == "ED") return turn(echoes_, words == "EE");
  if (words == "FV" || words == "FT") return turn(verbose_, words == "FV");
  if (words == "C")
    return result("PTU is in ", controls_speed_ ? "Pure Velocity Mode" : "Independent Mode");
  if (words == "L") return result("Limit bounds are ", limits_ ? "ENABLED" : "DISABLED");
  if (words == "E") return result("Echoing is ", echoes_ ? "ON" : "OFF");
  if (words == "F") return result("ASCII ", verbose_ ? "verbose mode" : "terse mode");
  if (words == "V") return result("", "2.14.0 PTU-D46, simulated");
  if (words == "O") return result("Voltage is ", "24.0", " V");
  return illegal();
}

std::string Unit::go(double time, Axis& axis, int position) {
  if (limits_ && (position > axis.most || position < axis.least)) {
    const bool is_above = position > axis.most;
    return refusal(std::string(is_above ? "Maximum" : "Minimum") + " allowable " + axis.name +
                   " position is " + std::to_string(is_above ? axis.most : axis.least));
  }
  // With limits disabled the axis runs into its end stop, and reports it.
  const int reached = std::clamp(position, axis.least, axis.most);
  axis.motion.go(time, reached);
  axis.runs_into_limit = reached != position;
  return kDone;
}

std::string Unit::set_speed(double time, Axis& axis, int speed) {
  if (std::abs(speed) > axis.upper)
    return refusal(std::string(axis.name) + " speed cannot exceed " + std::to_string(axis.upper) +
                   " positions/sec");
  const bool is_at_rest = controls_speed_ && speed == 0;
  if (!is_at_rest && (controls_speed_ ? std::abs(speed) : speed) < axis.lower)
    return refusal(std::string(axis.name) + " speed cannot be below " + std::to_string(axis.lower) +
                   " positions/sec");
  axis.speed = speed;
  if (is_at_rest) {
    axis.runs_into_limit = false;
    axis.motion.halt(time);
    return kDone;
  }
  Pace pace = axis.motion.pace();
  pace.speed = std::abs(speed);
  axis.motion.set_pace(time, pace);
  if (controls_speed_) {  // moves to the end stop
    axis.motion.go(time, speed > 0 ? axis.most : axis.least);
    axis.runs_into_limit = true;
  }
  return kDone;
}

std::string Unit::result(std::string_view verbose, std::string_view value,
                         std::string_view unit) const {
  std::string said = "* ";
  if (verbose_) said += verbose;
  said += value;
  if (verbose_) said += unit;
  return said + "\r\n";
}

}  // namespace hc::pan_tilt
