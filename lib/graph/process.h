// SPDX-License-Identifier: Apache-2.0
#pragma once
// Child processes, dead with all their descendants when we are.
//
// Between us and a program is its guard: a fork of us that starts the program, adopts what the
// program's processes leave behind (PR_SET_CHILD_SUBREAPER), and ends as the program did. It kills
// all that descends from the program when the program ends, when it is asked to, and when we have
// ended, however that came about: we hold a pipe to it that closes then. It leads a process group
// that the program begins in, and blocks all signals, so Ctrl-C at a terminal does not end it.
//
// Out of reach are processes that somebody else starts for the program (a service manager), that we
// may not signal (of another user), and, when the guard itself is killed, those that have left its
// group; the program dies with its guard even so.

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include <hc/os/descriptor.h>

namespace hc {

/// Status of a program that could not be executed, as shells have it.
inline constexpr int kCannotExecute = 127;

/// Descriptors that a program gets.
struct Given {
  int key = -1;                     ///< it gets this as kKeyDescriptor; -1: none
  std::vector<int> listeners = {};  ///< it gets these, and their numbers in kListeners
};

/// A child process. It is killed, with all that it has started, when the object goes.
class Process {
 public:
  enum class Capture { Output, Errors, Both };

  /// Starts a program; a name without a slash is looked up in PATH. Its standard input is empty;
  /// one of its standard output and standard error comes to us, the other is dropped. With Both we
  /// have all three. Does not wait until the program has been read, which a disk may take for ever:
  /// one that cannot be executed says why on its standard error, and has status kCannotExecute.
  ///
  /// @param given  what it gets of ours.
  ///
  /// Errors: System.
  static Result<Process> start(const std::vector<std::string>& command, Capture capture,
                               const Given& given = {});

  Process(Process&&) = default;
  ~Process();

  [[nodiscard]] pid_t number() const { return number_; }
  /// Of its guard, whose child the process is.
  [[nodiscard]] pid_t guard_number() const { return guard_; }
  /// What is captured; reading gives 0 bytes when all who could write have ended.
  [[nodiscard]] int output() const { return output_.get(); }
  /// With Capture::Both: its standard error, and its standard input, which is ours to write.
  [[nodiscard]] int errors() const { return errors_.get(); }
  [[nodiscard]] int input() const { return input_.get(); }
  /// Readable when the process has ended, and all that it had started has been killed.
  [[nodiscard]] int ended() const { return handle_.get(); }

  /// The exit status, 128 + the signal where one killed it; nothing while it runs.
  std::optional<int> poll_status();

  /// Asks the process, and all that is still in its group, to end (SIGTERM), also where they are
  /// stopped (SIGCONT).
  void ask_to_end() const;

  /// Kills the process and all that it has started; ended() is readable when that is done.
  void kill() { life_.reset(); }

 private:
  Process() = default;

  pid_t number_ = 0;
  pid_t guard_ = -1;   // its number, and that of its group
  Descriptor handle_;  // a pidfd
  Descriptor output_, errors_, input_;
  Descriptor life_;  // closed: the guard is to kill
  std::optional<int> status_;
  struct Owned {  // a moved-from process owns nothing
    bool flag = true;
    Owned() = default;
    Owned(Owned&& other) noexcept : flag(std::exchange(other.flag, false)) {}
  } owned_;
};

}  // namespace hc
