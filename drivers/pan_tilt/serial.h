// SPDX-License-Identifier: Apache-2.0
#pragma once
// A serial line: eight bits, no parity, one stop bit, no flow control, never waiting.

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc::pan_tilt {

/// An open tty, closed with its life. Errors do not say which it is.
class Serial {
 public:
  /// @param device  "/dev/ttyUSB0", or a pseudo-terminal's path. @param baud  300 … 4000000.
  ///
  /// Errors: NotFound (no such device), Unsupported (a rate that there is not; no serial line),
  /// System (another Serial has it open, …).
  static Result<Serial> open(const std::string& device, int baud);

  /// For poll().
  [[nodiscard]] int descriptor() const { return tty_.get(); }

  /// Reads what has come; none is nothing.
  ///
  /// Errors: Closed (the device is disconnected), System.
  Result<std::string_view> read(std::span<char> room);

  /// Writes all at once.
  ///
  /// Errors: Closed (the device is disconnected), System (it takes no more: nobody reads at its
  /// end).
  Status write(std::string_view bytes);

 private:
  explicit Serial(Descriptor tty) : tty_(std::move(tty)) {}

  Descriptor tty_;
};

}  // namespace hc::pan_tilt
