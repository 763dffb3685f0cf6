// SPDX-License-Identifier: Apache-2.0
#pragma once
// The host's side of the talk with a pan-tilt unit: who asked what, which answer belongs to it, and
// what to do when none comes or it makes no sense. Pure: bytes in, bytes out, at a time that is
// given and does not fall.

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <drivers/pan_tilt/protocol.h>
#include <hc/base/clock.h>

namespace hc::pan_tilt {

/// Where a head looks [rad]: pan > 0 to the left, tilt > 0 down. (The unit's own tilt is up.)
struct Gaze {
  double pan = 0, tilt = 0;
  MonotonicTime time{0};  ///< when it looked there: see Conversation::set_line()
};

/// Begins with `- ft ed ci`, asks what the unit is like, twice, since a wrong answer would stay,
/// and is ready when both agree. At most one question (both positions), one command (both axes),
/// one pace and one halt are without answer at a time; of commands that come meanwhile the newest
/// is sent. A line that brings garbage or no answer for kTimeOut is reset; what was commanded
/// before is not sent again, and its motion is halted, whether the unit answers or not.
class Conversation {
 public:
  static constexpr std::chrono::milliseconds kTimeOut{500};
  static constexpr std::chrono::milliseconds kQuiet{60};  ///< after garbage, before a new try
  static constexpr int kTries = 3;                        ///< before the line is lost
  static constexpr std::chrono::milliseconds kLife{200};  ///< of a command

  enum class Phase {
    Closed,  ///< there is no line
    Begins,  ///< it is being found out what is there
    Ready,   ///< commands are taken
    Lost,    ///< no valid answer in kTries tries: reopen the line
  };
  [[nodiscard]] Phase phase() const { return phase_; }

  /// The line has been opened or closed.
  void begin(MonotonicTime now);
  void end();

  /// What came.
  void take(MonotonicTime now, std::string_view bytes);
  /// Time passes: answers are overdue, motions are halted. To be called every few ms.
  void pass(MonotonicTime now);

  /// Asks where the unit looks, unless it was asked and has not answered.
  void look(MonotonicTime now);
  /// Has it turn there, or to the nearest it can; false when it is not ready, and nothing is done
  /// then. The angles are finite [rad].
  ///
  /// @param life  how long it may still be sent: one that waits longer for the answer to another is
  /// forgotten.
  bool command(MonotonicTime now, double pan, double tilt, std::chrono::nanoseconds life = kLife);
  /// How fast it turns [rad/s, rad/s²], or the nearest it can; 0: as it did when it was met. While
  /// the unit refuses a pace it is asked again every kTimeOut, and takes no commands.
  void set_pace(double speed, double acceleration);
  /// How fast bytes go either way [1/s]; 0, as at first: at once. A unit answers with where it is
  /// as the question arrives, behind all that was written before; the answer then takes its time,
  /// too. What time is left is taken to be as long before that as after it.
  void set_line(double bytes_per_second) { bytes_per_second_ = bytes_per_second; }
  /// Halts a motion that was commanded when no command was taken for so long, and what the unit may
  /// be at when it is met; 0: never.
  void set_hold(std::chrono::nanoseconds hold) { hold_ = hold; }
  /// A command that has not been sent yet is not sent any more.
  void forget() { wanted_.reset(); }
  /// Halts a motion that was commanded, at once.
  void halt(MonotonicTime now);
  /// What ends the motion that was commanded, if there may be one: for the end of a program.
  [[nodiscard]] std::string last_words() const { return heading_ ? "h " : ""; }

  // What is to be done now; each is given once.
  std::string bytes() { return std::exchange(bytes_, {}); }           ///< to be written
  std::optional<Gaze> gaze() { return std::exchange(gaze_, {}); }     ///< the unit has reported
  std::optional<Error> fault() { return std::exchange(fault_, {}); }  ///< why it is reset
  std::string remark() { return std::exchange(remark_, {}); }         ///< the unit refused that

  /// "pan -158.9 … 158.9 degrees, …", once it has been ready.
  [[nodiscard]] std::string character() const;

 private:
  // In the order in which they are asked.
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
  [[nodiscard]] std::chrono::nanoseconds on_line(std::size_t bytes) const;
  struct Look;
  [[nodiscard]] MonotonicTime seen_at(MonotonicTime now, const Look& look,
                                      std::size_t answered) const;
  [[nodiscard]] double tilt_at(MonotonicTime time, double seen);
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

  bool may_move_ = true;       // as somebody else has left it
  bool has_halted_ = false;    // in this try
  bool halt_follows_ = false;  // its answer comes after that to the first question
  int tries_ = 0;
  std::size_t asked_ = 0;  // while it begins: the setting that is being asked
  bool is_known_ = false;  // settings have been read on this line
  std::array<double, Settings> settings_ = {};
  std::optional<Pace> own_pace_, pace_;  // as it was met; as it is, none: refused
  MonotonicTime pace_at_{0};             // no pace is sent before
  double speed_ = 0, acceleration_ = 0;
  std::optional<MonotonicTime> quiet_at_;  // a new try, once nothing comes any more

  std::deque<Awaits> awaited_;
  MonotonicTime overdue_{0};  // when the oldest answer is
  MonotonicTime heading_since_{0}, commanded_{0};
  double bytes_per_second_ = 0;
  MonotonicTime written_{0};  // when all bytes are sent
  /// A question for the place.
  struct Look {
    MonotonicTime time;  // when it was asked,
    MonotonicTime sent;  // and when it had left
  };
  std::deque<Look> looks_;  // without an answer
  std::optional<Places> wanted_, heading_, place_;
  MonotonicTime wanted_until_{0};
  bool is_heading_sure_ = false;  // the unit has taken the command
  Places heard_ = {};
  std::size_t heard_bytes_ = 0;
  MonotonicTime place_time_{0};  // when place_ was asked
  struct TiltSeen {
    MonotonicTime time;  // of the pan
    double tilt;         // [rad], as it was answered
  };
  std::optional<TiltSeen> tilt_seen_;
  std::chrono::nanoseconds hold_{0};
};

}  // namespace hc::pan_tilt
