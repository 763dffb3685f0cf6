// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a module's processes are run and supervised, on this host and on others (hosts.h) alike.

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <hc/mtp/message.h>
#include <hc/os/loop.h>
#include <hc/os/procfs.h>

namespace hc {

/// What is called for a process. A callback may not destroy the ModuleProcess.
struct ModuleCallbacks {
  /// It has written to standard error. Returns whether more may be read at once.
  std::function<bool(std::string_view bytes)> said;
  std::function<void(const Message& report)> reported;
  /// It has connected to take commands. Returns the first ones.
  std::function<std::vector<Message>()> listens;
  /// It has ended, with all that it had started. What it has written and reported was handed over
  /// before. The status is 128 + the signal if one killed it.
  std::function<void(int status)> ended;
};

/// Runs the processes of one module, one after another. Used on the thread of a loop. The
/// destructor kills the process and all that it has started.
class ModuleProcess {
 public:
  virtual ~ModuleProcess() = default;

  /// Starts a process; none may run.
  /// @param control_uri  where it connects to for commands; empty: it takes none.
  ///
  /// Errors: System (also: a name is in use).
  virtual Status start(const std::vector<std::string>& command, const std::string& control_uri) = 0;
  [[nodiscard]] virtual bool runs() const = 0;
  /// Asks it to end (SIGTERM).
  virtual void ask_to_end() = 0;
  /// Kills it, with all that it has started; `ended` is called when that is done.
  virtual void kill() = 0;
  /// Notes its end at once, if it has ended, and not only in the next turn.
  virtual void look() = 0;
  /// Frees the names at which readers of its outputs connect, which are held between processes.
  virtual void let_names_go() = 0;

  [[nodiscard]] virtual bool is_listening() const = 0;
  /// Sends a command to a process that is listening; false: it does not read its commands.
  virtual bool send(const Message& command) = 0;

  /// Its process number on its host; 0 where that is not known, or none runs.
  [[nodiscard]] virtual pid_t number() const = 0;
  /// What it and all that it has started use.
  /// @param with_memory  whether to measure memory, and look for further processes.
  virtual Usage usage(bool with_memory) = 0;
};

/// Runs the processes of a module on this host.
/// @param manage_uri  where they report; it is listened to from now on.
/// @param key  descriptor that they get as kKeyDescriptor; -1: none.
///
/// Errors: Invalid, System (the name is in use).
Result<std::unique_ptr<ModuleProcess>> make_process_here(Loop& loop, const std::string& manage_uri,
                                                         int key, ModuleCallbacks callbacks);

/// Reads and drops the messages of a link whose reader has ended, as long as the result exists, so
/// that its writer does not wait.
/// @param reader_uri  the URI of the reader's end. Its time-outs are not used, and it does not keep
///     messages from being overwritten.
/// @param key  as above.
///
/// Errors: as open_source().
Result<std::shared_ptr<void>> read_in_place_here(Loop& loop, std::string reader_uri, int key);

}  // namespace hc
