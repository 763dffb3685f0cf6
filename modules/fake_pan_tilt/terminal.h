// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pseudo-terminal: a serial line whose other end is a program. It has no name but its number,
// which is free again once it is closed, however the program ends.

#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

class Terminal {
 public:
  /// Errors: System (there are no more).
  static hc::Result<Terminal> open();

  /// What others open.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// For poll().
  [[nodiscard]] int descriptor() const { return own_.get(); }
  /// What has come; never waits.
  std::string read();
  /// Writes what there is room for; the rest is lost, as on a line to which nobody listens.
  void write(std::string_view bytes);

 private:
  Terminal() = default;

  hc::Descriptor own_;
  hc::Descriptor other_;  // their end: open here too, so that one may leave and come back
  std::string path_;
};
