// SPDX-License-Identifier: Apache-2.0
#pragma once
// Child processes: each in a process group of its own, dead when we are. Internal to graph.

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include <hc/link/descriptor.h>

namespace hc::internal {

/// A child process. Its group is killed when the object goes.
class Process {
 public:
  enum class Capture { Output, Errors };

  /// Starts a program; a name without a slash is looked up in PATH. Its standard input is empty;
  /// one of its standard output and standard error comes to us, the other is dropped or ours.
  ///
  /// Errors: NotFound, System.
  static Result<Process> start(const std::vector<std::string>& command, Capture capture);

  Process(Process&&) = default;
  Process& operator=(Process&&) = default;
  ~Process();

  /// What is captured; reading gives 0 bytes when all who could write have ended.
  [[nodiscard]] int output() const { return output_.get(); }
  /// Readable when the process has ended.
  [[nodiscard]] int ended() const { return handle_.get(); }

  /// The exit status, 128 + the signal where one killed it; nothing while it runs.
  std::optional<int> poll_status();

  /// Sends a signal to the process and all that it has started.
  void signal(int number) const;

 private:
  Process() = default;

  pid_t number_ = -1;
  Descriptor handle_;  // a pidfd
  Descriptor output_;
  std::optional<int> status_;
  struct Owned {  // a moved-from process owns nothing
    bool flag = true;
    Owned() = default;
    Owned(Owned&& other) noexcept : flag(std::exchange(other.flag, false)) {}
    Owned& operator=(Owned&& other) noexcept {
      std::swap(flag, other.flag);
      return *this;
    }
  } owned_;
};

}  // namespace hc::internal
