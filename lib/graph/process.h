// SPDX-License-Identifier: Apache-2.0
#pragma once
// Child processes that end with this process, together with all their descendants.
//
// Each program runs under a guard: a fork of this process that starts the program, adopts its
// orphans (PR_SET_CHILD_SUBREAPER), and exits with its status. The guard kills all descendants of
// the program when the program ends, when asked to, and when this process ends for any reason,
// which closes a pipe to the guard. It leads a process group in which the program starts, and
// blocks all signals, so Ctrl-C at a terminal does not end it.
//
// Limits: processes started for the program by others (a service manager) or owned by another user
// survive; so do those that left the group if the guard itself is killed, but not the program.

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include <hc/os/descriptor.h>

namespace hc {

/// Exit status of a program that could not be executed, as in shells.
inline constexpr int kCannotExecute = 127;

/// Descriptors passed to a program.
struct Inherited {
  int key = -1;                     ///< becomes kKeyDescriptor; -1: none
  std::vector<int> listeners = {};  ///< keep their numbers, which are listed in kListeners
};

/// A child process. The destructor kills it and its descendants.
class Process {
 public:
  enum class Capture { Output, Errors, Both };

  /// Starts a program; a name without a slash is looked up in PATH. One of its standard output and
  /// standard error is captured, the other is dropped, and its standard input is empty; with Both,
  /// all three are pipes. Does not wait for exec, which a disk may delay for ever: a program that
  /// cannot be executed writes why to standard error and ends with kCannotExecute.
  ///
  /// Errors: System.
  static Result<Process> start(const std::vector<std::string>& command, Capture capture,
                               const Inherited& inherited = {});

  Process(Process&&) = default;
  ~Process();

  [[nodiscard]] pid_t number() const { return number_; }
  [[nodiscard]] pid_t guard_number() const { return guard_; }
  /// The captured output; its end is reached when the last writer has closed it.
  [[nodiscard]] int output() const { return output_.get(); }
  /// With Capture::Both: its standard error, for reading, and its standard input, for writing.
  [[nodiscard]] int errors() const { return errors_.get(); }
  [[nodiscard]] int input() const { return input_.get(); }
  /// Readable when the process has ended and its descendants have been killed.
  [[nodiscard]] int ended() const { return handle_.get(); }

  /// The exit status, 128 + the signal if killed by one; nullopt while it runs.
  std::optional<int> poll_status();

  /// Asks the process and its group to end (SIGTERM); resumes stopped processes (SIGCONT).
  void ask_to_end() const;

  /// Kills the process and its descendants; then ended() becomes readable.
  void kill() { life_.reset(); }

 private:
  Process() = default;

  pid_t number_ = 0;
  pid_t guard_ = -1;   // also the process group
  Descriptor handle_;  // a pidfd
  Descriptor output_, errors_, input_;
  Descriptor life_;  // closing it makes the guard kill
  std::optional<int> status_;
  struct Owned {  // a moved-from process owns nothing
    bool flag = true;
    Owned() = default;
    Owned(Owned&& other) noexcept : flag(std::exchange(other.flag, false)) {}
  } owned_;
};

}  // namespace hc
