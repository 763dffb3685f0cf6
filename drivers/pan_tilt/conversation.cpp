// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/conversation.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hc/base/format.h>

namespace hc::pan_tilt {
namespace {

constexpr std::array<const char*, 14> kQuestions = {"pr", "tr", "pn", "px", "tn", "tx", "pu",
                                                    "tu", "pl", "tl", "ps", "ts", "pa", "ta"};
// Turns a partial command left in the unit into an invalid one, which it refuses.
constexpr const char* kNoWord = "-";
constexpr const char* kNoAnswer = "no answer from the unit for 0.5 s";
static_assert(Conversation::kTimeOut == std::chrono::milliseconds(500));
constexpr std::string_view kAskPan = "pp", kAskTilt = "tp";
constexpr double kArcsecond = std::numbers::pi / 180 / 3600;  // [rad]
constexpr double kSlack = 50;  // beyond the distance at maximum speed [position]

Error garbage(const std::string& text) {
  return {Code::Malformed, "garbage: \"" + text + "\" is an unexpected answer"};
}

int bounded(double value, double least, double most) {
  return static_cast<int>(std::lround(std::clamp(value, least, most)));
}

}  // namespace

void Conversation::begin(MonotonicTime now) {
  end();
  tries_ = 0;
  is_known_ = false;
  try_again(now);
}

void Conversation::end() {
  phase_ = Phase::Closed;
  awaited_.clear();
  times_.forget();
  bytes_.clear();
  wanted_.reset();
  quiet_at_.reset();
  is_heading_sure_ = false;
  has_halted_ = halt_follows_ = false;
}

void Conversation::try_again(MonotonicTime now) {
  end();
  if (++tries_ > kTries) {
    phase_ = Phase::Lost;
    return;
  }
  phase_ = Phase::Begins;
  reader_ = {};
  place_.reset();
  asked_ = 0;
  overdue_ = now + kTimeOut;
  bytes_ = pan_tilt::command(kNoWord);
  halt_unheard(now);
  bytes_ += pan_tilt::command("ft") + pan_tilt::command("ed") + pan_tilt::command("ci") +
            pan_tilt::command(kQuestions[0]);
}

/// Halts a unit that may be moving and does not answer; once per try.
void Conversation::halt_unheard(MonotonicTime now) {
  const bool is_left = may_move_ || (heading_ && is_late(now));
  if (hold_.count() == 0 || !is_left || has_halted_) return;
  bytes_ += pan_tilt::command("h");
  has_halted_ = true;
}

/// Starts over: at once after silence, else when the garbage has ended.
void Conversation::fail(MonotonicTime now, Error error) {
  const bool is_silent = error.code == Code::Closed;
  fault_ = std::move(error);
  if (is_silent) return try_again(now);
  end();
  phase_ = Phase::Begins;
  quiet_at_ = now + kQuiet;
  overdue_ = now + kTimeOut;
}

void Conversation::take(MonotonicTime now, std::string_view bytes) {
  if (phase_ == Phase::Closed || phase_ == Phase::Lost || bytes.empty()) return;
  if (quiet_at_) {
    quiet_at_ = now + kQuiet;
    return;
  }
  reader_.feed(bytes);
  while (auto reply = reader_.next()) {
    // Echoes and answers of an earlier session precede the first answer.
    const bool is_first = phase_ == Phase::Begins && asked_ == 0;
    if (!*reply && is_first) continue;
    if (!*reply) return fail(now, reply->error());
    const Reply& said = **reply;
    if (said.kind == Reply::Kind::PanLimit || said.kind == Reply::Kind::TiltLimit) {
      remark_ = said.kind == Reply::Kind::PanLimit ? "pan has run into its limit"
                                                   : "tilt has run into its limit";
      continue;
    }
    phase_ == Phase::Begins ? hear_at_begin(now, said) : hear(now, said);
    if (quiet_at_) return;
  }
}

void Conversation::hear_at_begin(MonotonicTime now, const Reply& reply) {
  if (asked_ > 0 && reply.kind == Reply::Kind::Done && std::exchange(halt_follows_, false)) return;
  const auto value = number(reply.text);
  const bool is_number = reply.kind == Reply::Kind::Result && value;
  if (asked_ == 0) {
    if (!is_number || *value <= 0 || (is_known_ && *value != settings_[PR])) return;
    if (is_known_) return become_ready(now);
  } else if (!is_number || (asked_ >= Settings && *value != settings_[asked_ % Settings])) {
    return fail(now, garbage(reply.text));
  }
  settings_[asked_++ % Settings] = *value;
  if (asked_ == 2 * kQuestions.size()) return become_ready(now);
  overdue_ = now + kTimeOut;
  bytes_ += pan_tilt::command(kQuestions[asked_ % Settings]);
}

void Conversation::become_ready(MonotonicTime now) {
  const auto& s = settings_;
  const bool is_sound = s[PR] > 0 && s[TR] > 0 && s[PN] < s[PX] && s[TN] < s[TX] && s[PL] >= 0 &&
                        s[TL] >= 0 && s[PU] > 0 && s[TU] > 0 && s[PL] <= s[PU] && s[TL] <= s[TU] &&
                        std::all_of(s.begin(), s.end(), [](double v) { return std::abs(v) < 1e6; });
  if (!is_sound) return fail(now, {Code::Malformed, "garbage: inconsistent limits"});
  phase_ = Phase::Ready;
  tries_ = 0;
  may_move_ = false;
  if (std::exchange(halt_follows_, false)) say(now, "", {Awaits::Halted});
  Pace reported;
  for (std::size_t i = 0; i < reported.size(); ++i) reported[i] = bounded(s[PS + i], -1e6, 1e6);
  // Velocity control may have left a signed speed or 0.
  if (!own_pace_)
    own_pace_ = {reachable_speed(0, std::abs(s[PS])), reachable_speed(1, std::abs(s[TS])),
                 std::max(reported[2], 1), std::max(reported[3], 1)};
  // A unit that was power-cycled has lost its pace.
  pace_.reset();
  pace_at_ = now;
  if (!is_known_) pace_ = reported;
  is_known_ = true;
  send_pace(now);
}

void Conversation::say(MonotonicTime now, const std::string& bytes,
                       std::initializer_list<Awaits> answers) {
  if (awaited_.empty()) overdue_ = now + kTimeOut;
  bytes_ += bytes;
  times_.queued(bytes.size());
  awaited_.insert(awaited_.end(), answers);
}

std::string Conversation::bytes(MonotonicTime now) {
  times_.wrote(now);
  return std::exchange(bytes_, {});
}

bool Conversation::awaits(Awaits answer) const {
  return std::find(awaited_.begin(), awaited_.end(), answer) != awaited_.end();
}

void Conversation::look(MonotonicTime now) {
  // The previous tilt may still be on the line to us; the other direction is idle.
  is_look_due_ = awaits(Awaits::Pan);
  if (phase_ != Phase::Ready || is_look_due_) return;
  say(now, pan_tilt::command(kAskPan), {Awaits::Pan});
  times_.asked(now);
  say(now, pan_tilt::command(kAskTilt), {Awaits::Tilt});
}

bool Conversation::command(MonotonicTime now, double pan, double tilt,
                           std::chrono::nanoseconds life) {
  if (phase_ != Phase::Ready || !pace_) return false;
  const auto& s = settings_;
  commanded_ = now;
  wanted_until_ = now + life;
  wanted_ = {bounded(pan / step(0), s[PN], s[PX]), bounded(-tilt / step(1), s[TN], s[TX])};
  send_wanted(now);
  return true;
}

void Conversation::send_wanted(MonotonicTime now) {
  if (now > wanted_until_) wanted_.reset();
  if (!wanted_ || awaits(Awaits::TiltSet) || awaits(Awaits::PaceSet)) return;
  const Places places = *std::exchange(wanted_, std::nullopt);
  if (is_heading_sure_ && heading_ == places) return;
  heading_ = places;
  heading_since_ = now;
  is_heading_sure_ = true;
  say(now, pan_tilt::command("pp", places[0]) + pan_tilt::command("tp", places[1]),
      {Awaits::PanSet, Awaits::TiltSet});
}

void Conversation::set_pace(double speed, double acceleration) {
  if (speed != speed_ || acceleration != acceleration_) pace_at_ = MonotonicTime::min();
  speed_ = speed;
  acceleration_ = acceleration;
}

/// The nearest speed of which an axis is capable [position/s].
int Conversation::reachable_speed(std::size_t axis, double wanted) const {
  return bounded(wanted, std::max(settings_[PL + axis], 1.0), settings_[PU + axis]);
}

void Conversation::send_pace(MonotonicTime now) {
  if (awaits(Awaits::PaceSet) || now < pace_at_) return;
  const auto& s = settings_;
  Pace pace = *own_pace_;
  for (std::size_t axis : {0U, 1U}) {
    const double size = step(static_cast<int>(axis));
    if (speed_ > 0) pace[axis] = reachable_speed(axis, speed_ / size);
    if (acceleration_ > 0) pace[2 + axis] = bounded(acceleration_ / size, 1, 1e6);
  }
  if (pace_ == pace) return;
  for (std::size_t axis : {0U, 1U})
    if (const double least = pace[axis] * step(static_cast<int>(axis));
        speed_ > 0 && pace[axis] <= s[PL + axis] && speed_ < least)
      remark_ = "turns no slower than " + std::to_string(least) + " rad/s";
  pace_ = pace;
  std::string bytes;
  for (std::size_t i = 0; i < pace.size(); ++i)
    bytes += pan_tilt::command(kQuestions[PS + i], pace[i]);
  say(now, bytes, {Awaits::PaceSet, Awaits::PaceSet, Awaits::PaceSet, Awaits::PaceSet});
}

void Conversation::hear(MonotonicTime now, const Reply& reply) {
  const bool is_place =
      !awaited_.empty() && (awaited_.front() == Awaits::Pan || awaited_.front() == Awaits::Tilt);
  const auto fitting = is_place ? Reply::Kind::Result : Reply::Kind::Done;
  const bool is_refusal = reply.kind == Reply::Kind::Refused;
  if (awaited_.empty() || (reply.kind != fitting && !is_refusal))
    return fail(now, garbage((is_refusal ? "! " : "* ") + reply.text));
  const Awaits awaited = awaited_.front();
  awaited_.pop_front();
  overdue_ = now + kTimeOut;
  times_.answered(now, awaited == Awaits::Pan);
  if (is_refusal) {
    remark_ = "refused: " + reply.text;
    if (awaited == Awaits::PanSet || awaited == Awaits::TiltSet) is_heading_sure_ = false;
    if (is_place) return fail(now, garbage("! " + reply.text));
    if (awaited == Awaits::PaceSet) {  // do not move with a wrong pace
      pace_.reset();
      pace_at_ = now + kTimeOut;
      wanted_.reset();
    }
  } else if (awaited == Awaits::Halted && !awaits(Awaits::TiltSet)) {
    heading_.reset();
  } else if (is_place) {
    hear_place(now, awaited == Awaits::Pan ? 0 : 1, reply.text);
  }
  if (phase_ != Phase::Ready) return;
  send_wanted(now);
  if (is_look_due_) look(now);
}

void Conversation::hear_place(MonotonicTime now, int axis, const std::string& text) {
  const auto value = number(text);
  if (!value) return fail(now, value.error());
  const auto i = static_cast<std::size_t>(axis);
  const double seconds = hc::seconds(now - place_time_);
  const double most = settings_[PU + i] * seconds + kSlack;
  if (std::abs(*value) > 1e6 || std::trunc(*value) != *value ||
      (place_ && std::abs(*value - (*place_)[i]) > most))
    return fail(now, {Code::Malformed, "garbage: impossible position " + text});
  heard_[i] = static_cast<int>(*value);
  constexpr std::size_t kFrame = 4;  // "* " and the line end
  heard_bytes_ = (axis == 0 ? 0 : heard_bytes_) + text.size() + kFrame;
  if (axis == 0) return;
  place_ = heard_;
  place_time_ = times_.heard(heard_bytes_);
  // Such a late answer was waiting to be read: its time is unknown.
  if (now - place_time_ >= kTimeOut) return;
  const auto time = times_.seen_at(now);
  const double tilt = -heard_[1] * step(1);
  gaze_ = Gaze{heard_[0] * step(0), times_.tilt_at(time, tilt, kAskTilt.size() + 1), time};
}

/// Whether the unit has reached the commanded position.
bool Conversation::arrived() const {
  return place_ && place_time_ > heading_since_ && std::abs((*place_)[0] - (*heading_)[0]) <= 1 &&
         std::abs((*place_)[1] - (*heading_)[1]) <= 1;
}

void Conversation::pass(MonotonicTime now) {
  if (phase_ == Phase::Begins) {
    const bool is_quiet = quiet_at_ && now >= *quiet_at_;
    if (!quiet_at_ && now >= overdue_) fault_ = Error{Code::Closed, kNoAnswer};
    if (is_quiet || now >= overdue_) {
      try_again(now);
    } else if (!has_halted_) {
      halt_unheard(now);
      halt_follows_ = has_halted_ && !quiet_at_;
    }
  }
  if (phase_ != Phase::Ready) return;
  if (!awaited_.empty() && now >= overdue_) return fail(now, {Code::Closed, kNoAnswer});
  send_pace(now);
  if (is_late(now)) halt(now);
}

void Conversation::halt(MonotonicTime now) {
  forget();
  if (phase_ != Phase::Ready || !heading_ || awaits(Awaits::Halted) || arrived()) return;
  is_heading_sure_ = false;  // the heading ends when the answer arrives
  say(now, pan_tilt::command("h"), {Awaits::Halted});
}

/// Whether the last command is older than the hold time.
bool Conversation::is_late(MonotonicTime now) const {
  return hold_.count() > 0 && now - commanded_ > hold_;
}

double Conversation::step(int axis) const {
  return settings_[static_cast<std::size_t>(axis)] * kArcsecond;
}

std::string Conversation::character() const {
  const auto& s = settings_;
  const auto degrees = [&](int axis, double positions) {
    return positions * step(axis) * 180 / std::numbers::pi;
  };
  return hc::format("pan from {:.1f} to {:.1f}, tilt from {:.1f} (up) to {:.1f} (down) degrees",
                    degrees(0, s[PN]), degrees(0, s[PX]), -degrees(1, s[TX]), -degrees(1, s[TN]));
}

}  // namespace hc::pan_tilt
