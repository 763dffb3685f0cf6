// SPDX-License-Identifier: Apache-2.0
#pragma once
// A run of a module. Internal.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hc/module/module.h>

namespace hc {

/// From the command line to the exit status: Module::run(), and a loop of messages in a script.
class Module::Run {
 public:
  /// Opens the links, or prints what was asked for.
  /// @param words  the command line, without the program's name.
  Run(Module& module, const std::vector<std::string>& words);
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Calls handlers until the end.
  void work();
  /// The next message of an input, while handlers are called for others. None: the input or the run
  /// has ended.
  std::optional<Message> next(internal::InputState& input);
  /// No further message is given: an output has lost its readers.
  void stop() { is_stopped_ = true; }
  /// An error elsewhere ends it: on_end() is not called.
  void fail() { status_ = 1; }
  /// Whether it has failed, or done what it was asked for, such as --help.
  [[nodiscard]] bool has_status() const { return status_.has_value(); }
  /// Closes the links.
  /// @returns  what main() is to return.
  int end();

 private:
  [[nodiscard]] bool is_working() const { return !status_ && !is_stopped_; }
  void begin(const std::vector<std::string>& words);
  template <typename Work>
  void attempt(const Work& work);

  Module& module_;
  std::unique_ptr<internal::Arguments> arguments_;
  std::unique_ptr<Loop> loop_;
  bool is_stopped_ = false;  // no reader is left, or it was asked to stop: a clean end
  std::string error_;        // logged at the end, after what its links have to say
  std::optional<int> status_;
};

}  // namespace hc
