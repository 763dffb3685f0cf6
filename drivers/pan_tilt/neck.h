// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pan-tilt unit on its serial line: opens it, keeps the conversation going, reconnects, and logs
// a line for each change. Never waits.

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <drivers/pan_tilt/conversation.h>
#include <drivers/pan_tilt/serial.h>
#include <hc/base/backoff.h>
#include <hc/base/clock.h>
#include <hc/base/log.h>
#include <hc/base/turn.h>

namespace hc::pan_tilt {

/// What may be changed at any time.
struct NeckSettings {
  std::string device;  ///< whose name stays valid while it is unplugged, as a serial port's
  int baud = 9600;
  double speed = 0, acceleration = 0;  ///< as of Conversation::set_pace()
  std::chrono::nanoseconds hold{0};    ///< as of Conversation::set_hold()
  double age = 0.2;  ///< maximum of a command's time and now apart, past or future [s]
};

/// Where to turn to.
struct NeckCommand {
  double pan = 0, tilt = 0;           ///< finite, as in Gaze [rad]
  std::int64_t time = 0;              ///< when it was given [ns since the Unix epoch]; 0: unknown
  std::int32_t mode = 0, source = 0;  ///< whose it is
};

class Neck {
 public:
  static constexpr std::chrono::seconds kSettled{1};  ///< without a fault, before it counts as well
  static constexpr std::chrono::milliseconds kTick{10};  ///< how often pass() is to be called
  static constexpr std::chrono::milliseconds kTurn{150};
  using Problem = std::function<void(const std::string& kind, std::string_view line)>;
  using Seen = std::function<void(const Gaze& gaze)>;

  /// @param log  gets a line when the unit is connected, disconnected, or refuses something.
  /// @param problem  gets why a command is dropped, to log the first of a kind.
  /// @param seen  called by read() and pass() with each measured gaze.
  Neck(LogSink log, Problem problem, Seen seen)
      : log_(std::move(log)), problem_(std::move(problem)), seen_(std::move(seen)) {}
  Neck(const Neck&) = delete;
  Neck& operator=(const Neck&) = delete;
  ~Neck() { leave(); }

  /// The device to open, until that of the settings changes; "" for none. The same again changes
  /// nothing. The number of a pseudo-terminal may be another's once it is unplugged, so it has to
  /// be set again then.
  void set_device(MonotonicTime now, std::string_view device) { use(now, device, false); }

  /// For poll(); -1 while no line is open.
  [[nodiscard]] int descriptor() const { return serial_ ? serial_->descriptor() : -1; }
  /// Reads what has come.
  void read(MonotonicTime now);
  /// To be called every kTick: opens, reads, retries, halts. The settings hold from now on.
  void pass(MonotonicTime now, const NeckSettings& settings);

  void look(MonotonicTime now);
  /// Turns the head. A command without a time, older than the settings' `age` or as far in the
  /// future, or for a unit that is not connected, is dropped and given to `problem`; and so are
  /// those of a second source of the same mode, until the first has been silent for kTurn.
  /// @param wall  now, on the clock of `command.time` [ns since the Unix epoch].
  void command(MonotonicTime now, std::int64_t wall, const NeckCommand& command);
  /// Says which mode has the focus; to be called before commands and read(). When it changes, a
  /// command that waits to be sent is forgotten. When nobody has it any more, the motion is halted.
  void set_focus(MonotonicTime now, std::int32_t mode);
  /// Halts a motion that was commanded, and lets go of the line; so does the destructor.
  void leave();

 private:
  void set(MonotonicTime now, const NeckSettings& settings);
  void set_baud(MonotonicTime now, int baud);
  /// @param stays  the name stays valid while the device is unplugged.
  void use(MonotonicTime now, std::string_view device, bool stays);
  void open(MonotonicTime now);
  /// @param why  of Code::Closed where the device is disconnected.
  void close(MonotonicTime now, const Error& why);
  void work(MonotonicTime now);
  void log_fault(const Error& error);

  LogSink log_;
  Problem problem_;
  Seen seen_;
  NeckSettings settings_;
  Conversation conversation_;
  std::optional<Serial> serial_;
  std::string device_;
  int baud_ = 9600;
  bool stays_ = true;
  Backoff backoff_;
  std::set<std::string> faults_;  // logged since all was well
  std::set<std::string> remarks_;
  bool was_ready_ = false;
  MonotonicTime well_since_{0};
  Turn<std::int32_t> turn_{kTurn};  // of a source
  std::int32_t mode_ = 0;           // of the last command
  std::int32_t focus_ = 0;
};

}  // namespace hc::pan_tilt
