// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pseudo-terminal: a serial line whose other end is a program. Its device number is released when
// it closes, however the program ends.

#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

class Terminal {
 public:
  /// Errors: System (none left).
  static hc::Result<Terminal> open();

  /// The device to open.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// For poll().
  [[nodiscard]] int descriptor() const { return own_.get(); }
  /// Reads the bytes available; never blocks.
  std::string read();
  /// Writes as much as fits; the rest is lost, as on a line without a reader.
  void write(std::string_view bytes);

 private:
  Terminal() = default;

  hc::Descriptor own_;
  hc::Descriptor other_;  // the device's end, kept open so that a client can disconnect and reopen
  std::string path_;
};
