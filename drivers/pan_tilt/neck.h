// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pan-tilt unit on its serial line: opens it, keeps the conversation going, reconnects, and logs
// a line for each change. Never waits.

#include <functional>
#include <optional>
#include <set>
#include <string>

#include <drivers/pan_tilt/conversation.h>
#include <drivers/pan_tilt/serial.h>
#include <hc/base/backoff.h>
#include <hc/base/clock.h>

namespace hc::pan_tilt {

class Neck {
 public:
  static constexpr std::chrono::seconds kSettled{1};  ///< without a fault, before it counts as well

  /// @param log  gets a line when the unit is connected, disconnected, or refuses something.
  explicit Neck(std::function<void(std::string_view)> log) : log_(std::move(log)) {}

  /// The device to open; "" for none. The same again changes nothing.
  ///
  /// @param stays  the name stays valid while the device is unplugged, as a serial port's; the
  /// number of a pseudo-terminal may be another's by then, so it has to be set again.
  void set_device(MonotonicTime now, const std::string& device, bool stays);
  /// Its baud rate; 9600 at first. The same again changes nothing.
  void set_baud(MonotonicTime now, int baud);

  /// For poll(); -1 while no line is open.
  [[nodiscard]] int descriptor() const { return serial_ ? serial_->descriptor() : -1; }
  /// Reads what has come.
  void read(MonotonicTime now);
  /// Time passes; to be called every few ms.
  void pass(MonotonicTime now);

  void look(MonotonicTime now);
  bool command(MonotonicTime now, double pan, double tilt,
               std::chrono::nanoseconds life = Conversation::kLife);
  /// Halts a motion that was commanded, and lets go of the line.
  void leave();

  Conversation& conversation() { return conversation_; }

 private:
  void open(MonotonicTime now);
  /// @param why  of Code::Closed where the device is disconnected.
  void close(MonotonicTime now, const Error& why);
  void work(MonotonicTime now);
  void log_fault(const Error& error);

  std::function<void(std::string_view)> log_;
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
};

}  // namespace hc::pan_tilt
