// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pseudo-terminal: a serial line whose other end is a program. It has no name but its number,
// which is free again once it is closed, however the program ends.

#include <string>
#include <string_view>
#include <utility>

#include <hc/base/result.h>

class Terminal {
 public:
  /// Errors: System (there are no more).
  static hc::Result<Terminal> open();
  Terminal(Terminal&& other) noexcept
      : own_(std::exchange(other.own_, -1)),
        other_(std::exchange(other.other_, -1)),
        path_(std::move(other.path_)) {}
  Terminal& operator=(Terminal&& other) noexcept;
  ~Terminal();

  /// What others open.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// For poll().
  [[nodiscard]] int descriptor() const { return own_; }
  /// What has come; never waits.
  std::string read();
  /// Writes what there is room for; the rest is lost, as on a line to which nobody listens.
  void write(std::string_view bytes);

 private:
  Terminal() = default;

  int own_ = -1;
  int other_ = -1;  // the end of the others: open here too, so that one may leave and come back
  std::string path_;
};
