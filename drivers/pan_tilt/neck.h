// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pan-tilt unit on its serial line: opens it, runs the conversation, reconnects, and logs each
// change. Never blocks.

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

/// Settings that may change at any time.
struct NeckSettings {
  std::string device;  ///< name that stays valid while unplugged, like a serial port's
  int baud = 9600;
  double speed = 0, acceleration = 0;  ///< as in Conversation::set_pace()
  std::chrono::nanoseconds hold{0};    ///< as in Conversation::set_hold()
  double age = 0.2;  ///< maximum difference of a command's time from now, past or future [s]
};

/// A commanded orientation.
struct NeckCommand {
  double pan = 0, tilt = 0;           ///< finite, as in Gaze [rad]
  Time time;                          ///< Time{}: unknown
  std::int32_t mode = 0, source = 0;  ///< of the sender
};

class Neck {
 public:
  static constexpr std::chrono::seconds kSettled{1};     ///< time without a fault until reconnected
  static constexpr std::chrono::milliseconds kTick{10};  ///< period of pass()
  static constexpr std::chrono::milliseconds kTurn{150};
  using Problem = std::function<void(const std::string& kind, std::string_view line)>;
  using Seen = std::function<void(const Gaze& gaze)>;

  /// @param clock  the machine's, since a unit moves at its pace; must outlive it.
  /// @param log  called when the unit is connected, disconnected, or refuses a command.
  /// @param problem  called with the reason when a command is dropped.
  /// @param seen  called by read() and pass() with each measured gaze.
  Neck(const Clock& clock, LogSink log, Problem problem, Seen seen)
      : clock_(clock), log_(std::move(log)), problem_(std::move(problem)), seen_(std::move(seen)) {}
  Neck(const Neck&) = delete;
  Neck& operator=(const Neck&) = delete;
  ~Neck() { leave(); }

  /// Sets the device to open, until that of the settings changes; "": none. Forgotten when
  /// unplugged, since the number of a pseudo-terminal may then belong to another.
  void set_device(std::string_view device) { use(device, false); }

  /// For poll(); -1 while no line is open.
  [[nodiscard]] int descriptor() const { return serial_ ? serial_->descriptor() : -1; }
  /// Reads the bytes available.
  void read();
  /// Call every kTick: opens, reads, retries, halts; applies the settings.
  void pass(const NeckSettings& settings);

  void look();
  /// Turns the head. Drops, with a call of `problem`, commands without a time, more than the
  /// settings' `age` old or in the future, for a disconnected unit, and of a second source of the
  /// same mode until the first has been silent for kTurn.
  /// @param wall  now, on the clock of `command.time`.
  void command(Time wall, const NeckCommand& command);
  /// Sets the mode in focus; call before command() and read(). A change drops a command not yet
  /// sent; mode 0 halts the motion.
  void set_focus(std::int32_t mode);
  /// Halts a commanded motion, and closes the line; so does the destructor.
  void leave();

 private:
  void set(const NeckSettings& settings);
  void set_baud(int baud);
  /// @param stays  whether the name stays valid while the device is unplugged.
  void use(std::string_view device, bool stays);
  void open();
  /// @param why  Code::Closed if the device is disconnected.
  void close(const Error& why);
  void work();
  void log_fault(const Error& error);

  const Clock& clock_;
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
  std::set<std::string> faults_;  // logged since it was last connected
  std::set<std::string> remarks_;
  bool was_ready_ = false;
  MonotonicTime well_since_{0};
  Turn<std::int32_t> turn_{kTurn};  // the active source
  std::int32_t mode_ = 0;           // of the last command
  std::int32_t focus_ = 0;
};

}  // namespace hc::pan_tilt
