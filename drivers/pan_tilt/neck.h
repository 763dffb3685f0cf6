// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pan-tilt unit at its serial line: opens it, keeps the conversation going, opens it again when
// it was lost, and tells of that in a line each. Never waits.

#include <functional>
#include <optional>
#include <set>
#include <string>

#include <drivers/pan_tilt/conversation.h>
#include <drivers/pan_tilt/serial.h>

namespace hc::pan_tilt {

class Neck {
 public:
  static constexpr std::chrono::milliseconds kFirstPause{100}, kLongestPause{2000};
  static constexpr std::chrono::seconds kSettled{1};  ///< without a fault, before it is called well

  /// @param tell  hears a line when the unit is there, gone, or refuses something.
  explicit Neck(std::function<void(std::string_view)> tell) : tell_(std::move(tell)) {}

  /// What to open; "" for none. The same again changes nothing.
  ///
  /// @param stays  the name stays valid when the device has gone, as of a serial port's; the number
  /// of a pseudo-terminal may be another's by then, so its name has to be told again.
  void set_device(MonotonicTime now, const std::string& device, int baud, bool stays);

  /// For poll(); -1 while no line is open.
  [[nodiscard]] int descriptor() const { return serial_ ? serial_->descriptor() : -1; }
  /// Takes what has come.
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
  /// @param why  of Code::Closed where the device itself has gone.
  void close(MonotonicTime now, const Error& why);
  void work(MonotonicTime now);
  void tell_fault(const Error& error);

  std::function<void(std::string_view)> tell_;
  Conversation conversation_;
  std::optional<Serial> serial_;
  std::string device_;
  int baud_ = 9600;
  bool stays_ = true;
  MonotonicTime try_at_{0};
  std::chrono::nanoseconds pause_ = kFirstPause;
  std::set<std::string> told_;  // since all was well
  std::set<std::string> remarks_;
  bool was_ready_ = false;
  MonotonicTime well_since_{0};
};

}  // namespace hc::pan_tilt
