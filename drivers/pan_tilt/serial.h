// SPDX-License-Identifier: Apache-2.0
#pragma once
// A serial line: eight bits, no parity, one stop bit, no flow control, non-blocking.

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc::pan_tilt {

/// An open tty. Error texts do not contain its name.
class Serial {
 public:
  /// @param device  "/dev/ttyUSB0", or a pseudo-terminal's path. @param baud  300 … 4000000.
  ///
  /// Errors: NotFound (no such device), Unsupported (no such rate; not a serial line), System (in
  /// use by another Serial, …).
  static Result<Serial> open(const std::string& device, int baud);

  /// For poll().
  [[nodiscard]] int descriptor() const { return tty_.get(); }

  /// Reads the bytes available; may be empty.
  ///
  /// Errors: Closed (the device is disconnected), System.
  Result<std::string_view> read(std::span<char> room);

  /// Writes all at once.
  ///
  /// Errors: Closed (the device is disconnected), System (the output buffer is full).
  Status write(std::string_view bytes);

 private:
  explicit Serial(Descriptor tty) : tty_(std::move(tty)) {}

  Descriptor tty_;
};

}  // namespace hc::pan_tilt
