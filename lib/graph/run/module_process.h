// SPDX-License-Identifier: Apache-2.0
#pragma once
// The process of a module as who supervises it sees it, whether it runs on this host or on another
// one (hosts.h). Internal to graph.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <graph/run/process.h>
#include <hc/base/result.h>
#include <hc/os/procfs.h>

namespace hc::internal {

/// A process that runs, or has ended. With the object it is killed, and all that it has started.
class ModuleProcess {
 public:
  virtual ~ModuleProcess() = default;

  /// Its process number on its host; 0 where that is not known, or there is none any more.
  [[nodiscard]] virtual pid_t number() const = 0;
  /// A descriptor with what it writes to standard error; 0 bytes when that has ended.
  [[nodiscard]] virtual int output() const = 0;
  /// A descriptor that is readable when it has ended, and all that it had started.
  [[nodiscard]] virtual int ended() const = 0;
  /// The exit status, 128 + the signal where one killed it; nothing while it runs.
  virtual std::optional<int> poll_status() = 0;
  /// Asks it to end (SIGTERM).
  virtual void ask_to_end() = 0;
  /// Has it killed; ended() says when that is done.
  virtual void kill() = 0;
  /// What it and all that it has started use.
  /// @param with_memory  whether the memory is wanted, and who has been started meanwhile.
  virtual Usage usage(bool with_memory) = 0;
};

/// Starts a module on this host. Errors: NotFound, System.
Result<std::unique_ptr<ModuleProcess>> start_here(const std::vector<std::string>& command,
                                                  const Given& given);

}  // namespace hc::internal
