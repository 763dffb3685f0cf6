// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs and supervises a module's processes, on this host and on others (hosts.h).

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

/// Callbacks for a process. They must not destroy the ModuleProcess.
struct ModuleCallbacks {
  /// Output to standard error. Returns whether to read on without a pause.
  std::function<bool(std::string_view bytes)> wrote;
  std::function<void(const Message& report)> reported;
  /// It has connected for commands. Returns the first ones.
  std::function<std::vector<Message>()> connected;
  /// It and its descendants have ended, after its last output and report. The status is 128 + the
  /// signal if it was killed by one.
  std::function<void(int status)> ended;
};

/// Runs the processes of one module, one after another. Used on the thread of a loop. The
/// destructor kills the process and its descendants.
class ModuleProcess {
 public:
  virtual ~ModuleProcess() = default;

  /// Starts a process; none may be running.
  /// @param control_uri  to which it connects for commands; empty: it takes none.
  ///
  /// Errors: System (also if a name is in use).
  virtual Status start(const std::vector<std::string>& command, const std::string& control_uri) = 0;
  [[nodiscard]] virtual bool runs() const = 0;
  /// Asks it to end (SIGTERM).
  virtual void ask_to_end() = 0;
  /// Kills it and its descendants, then calls `ended`.
  virtual void kill() = 0;
  /// Calls `ended` now if it has ended, instead of in the next turn.
  virtual void check_end() = 0;
  /// Frees the socket names of its outputs, which are held between processes.
  virtual void release_names() = 0;

  [[nodiscard]] virtual bool is_listening() const = 0;
  /// Sends a command to a process that is listening; false: its queue is full.
  virtual bool send(const Message& command) = 0;

  /// Its PID on its host; 0 if unknown or not running.
  [[nodiscard]] virtual pid_t number() const = 0;
  /// The usage of it and its descendants.
  /// @param with_memory  measures memory and looks for new descendants.
  virtual Usage usage(bool with_memory) = 0;
};

/// Runs the processes of a module on this host.
/// @param manage_uri  for their reports; listens there at once.
/// @param key  descriptor passed to them as kKeyDescriptor; -1: none.
///
/// Errors: Invalid, System (the name is in use).
Result<std::unique_ptr<ModuleProcess>> make_process_here(Loop& loop, const std::string& manage_uri,
                                                         int key, ModuleCallbacks callbacks);

/// Reads and drops the messages of a link whose reader has ended, for the lifetime of the result,
/// so that its writer does not block.
/// @param reader_uri  of the reader's end; its time-outs and policy are ignored.
/// @param key  as above.
///
/// Errors: as open_source().
Result<std::shared_ptr<void>> read_in_place_here(Loop& loop, std::string reader_uri, int key);

}  // namespace hc
