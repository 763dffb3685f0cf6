// SPDX-License-Identifier: Apache-2.0
#pragma once
// The host's side of the dialogue with a pan-tilt unit: matches answers to questions, and handles
// missing and invalid ones. Pure: bytes in, bytes out; times come from the caller and do not
// decrease, but that of pass() may be before the last one.

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <drivers/pan_tilt/line_times.h>
#include <drivers/pan_tilt/protocol.h>
#include <hc/base/clock.h>

namespace hc::pan_tilt {

/// Orientation of a head [rad]: pan > 0 left, tilt > 0 down. (The unit's tilt > 0 is up.)
struct Gaze {
  double pan = 0, tilt = 0;
  MonotonicTime time{0};  ///< see LineTimes
};

/// Starts with `- ft ed ci`, then queries the unit's settings twice, since an error would persist,
/// and is ready when both agree. At most one question (both positions), one command (both axes),
/// one pace and one halt are unanswered at a time; of commands given meanwhile only the newest is
/// sent. After garbage, or without an answer for kTimeOut, the line is reset; earlier commands are
/// not repeated, and their motion is halted, even if the unit does not answer.
class Conversation {
 public:
  static constexpr std::chrono::milliseconds kTimeOut{500};
  static constexpr std::chrono::milliseconds kQuiet{60};  ///< silence after garbage, before a retry
  static constexpr int kTries = 3;                        ///< until the line is lost
  static constexpr std::chrono::milliseconds kLife{200};  ///< of a queued command

  enum class Phase {
    Closed,  ///< no line
    Begins,  ///< querying the unit
    Ready,   ///< accepts commands
    Lost,    ///< no valid answer in kTries tries: reopen the line
  };
  [[nodiscard]] Phase phase() const { return phase_; }

  /// The line has been opened or closed.
  void begin(MonotonicTime now);
  void end();

  void take(MonotonicTime now, std::string_view bytes);
  /// Handles timeouts: overdue answers, motions to halt. Call every few ms.
  void pass(MonotonicTime now);

  /// Queries the position; while a query is unanswered, as soon as it is answered.
  void look(MonotonicTime now);
  /// Turns to these finite angles [rad], or the nearest reachable. False if not ready.
  ///
  /// @param life  a command that waits longer for another's answer is dropped.
  bool command(MonotonicTime now, double pan, double tilt, std::chrono::nanoseconds life = kLife);
  /// Sets the speed and acceleration [rad/s, rad/s²], or the nearest possible; 0: as found at the
  /// start. While the unit refuses a pace, it is sent again every kTimeOut, and commands fail.
  void set_pace(double speed, double acceleration);
  /// Sets the rate of bytes in each direction [1/s]; 0 (default): infinite.
  void set_line(double bytes_per_second) { times_.set_rate(bytes_per_second); }
  /// Halts a commanded motion after this time without a command, and any motion found at the start;
  /// 0: never.
  void set_hold(std::chrono::nanoseconds hold) { hold_ = hold; }
  /// Drops a command not yet sent.
  void forget() { wanted_.reset(); }
  /// Halts a commanded motion at once.
  void halt(MonotonicTime now);
  /// The bytes that halt a commanded motion, to write at the end of a program; empty if none.
  [[nodiscard]] std::string last_words() const { return heading_ ? "h " : ""; }

  // Results, each returned once.
  std::string bytes(MonotonicTime now);                               ///< to write now
  std::optional<Gaze> gaze() { return std::exchange(gaze_, {}); }     ///< reported by the unit
  std::optional<Error> fault() { return std::exchange(fault_, {}); }  ///< reason of a reset
  std::string remark() { return std::exchange(remark_, {}); }         ///< e.g. a refusal

  /// "pan from -158.9 to 158.9, …"; valid once ready.
  [[nodiscard]] std::string character() const;

 private:
  // In the order of the queries.
  enum Setting { PR, TR, PN, PX, TN, TX, PU, TU, PL, TL, PS, TS, PA, TA, Settings };
  enum class Awaits { Pan, Tilt, PanSet, TiltSet, PaceSet, Halted };
  using Places = std::array<int, 2>;  // pan, tilt [position]
  using Pace = std::array<int, 4>;    // PS TS PA TA

  void fail(MonotonicTime now, Error error);
  void try_again(MonotonicTime now);
  void hear_at_begin(MonotonicTime now, const Reply& reply);
  void become_ready(MonotonicTime now);
  void hear(MonotonicTime now, const Reply& reply);
  void hear_place(MonotonicTime now, int axis, const std::string& text);
  void say(MonotonicTime now, const std::string& bytes, std::initializer_list<Awaits> answers);
  void send_wanted(MonotonicTime now);
  void send_pace(MonotonicTime now);
  [[nodiscard]] bool awaits(Awaits answer) const;
  [[nodiscard]] bool arrived() const;
  [[nodiscard]] bool is_late(MonotonicTime now) const;
  void halt_unheard(MonotonicTime now);
  [[nodiscard]] double step(int axis) const;  // [rad]
  [[nodiscard]] int reachable_speed(std::size_t axis, double wanted) const;

  Phase phase_ = Phase::Closed;
  ReplyReader reader_;
  std::string bytes_, remark_;
  std::optional<Gaze> gaze_;
  std::optional<Error> fault_;

  bool may_move_ = true;       // from an earlier session
  bool has_halted_ = false;    // in this try
  bool halt_follows_ = false;  // the halt's answer follows that to the first question
  int tries_ = 0;
  std::size_t asked_ = 0;  // in Phase::Begins: the setting being queried
  bool is_known_ = false;  // settings have been read on this line
  std::array<double, Settings> settings_ = {};
  std::optional<Pace> own_pace_, pace_;  // found at the start; current, none if refused
  MonotonicTime pace_at_{0};             // earliest time to send a pace
  double speed_ = 0, acceleration_ = 0;
  std::optional<MonotonicTime> quiet_at_;  // when to retry, unless more garbage arrives

  std::deque<Awaits> awaited_;
  MonotonicTime overdue_{0};  // deadline of the oldest answer
  MonotonicTime heading_since_{0}, commanded_{0};
  LineTimes times_;
  bool is_look_due_ = false;
  std::optional<Places> wanted_, heading_, place_;
  MonotonicTime wanted_until_{0};
  bool is_heading_sure_ = false;  // the unit has accepted the command
  Places heard_ = {};
  std::size_t heard_bytes_ = 0;
  MonotonicTime place_time_{0};  // when place_ was queried
  std::chrono::nanoseconds hold_{0};
};

}  // namespace hc::pan_tilt
