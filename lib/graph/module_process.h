// SPDX-License-Identifier: Apache-2.0
#pragma once
// The processes of a module as who supervises them sees them, whether they run on this host or on
// another one (hosts.h).

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

/// What a process does, as it is noted. None may destroy the ModuleProcess.
struct ModuleCallbacks {
  /// Takes what it writes to standard error. Returns whether more may come at once.
  std::function<bool(std::string_view bytes)> said;
  std::function<void(const Message& report)> reported;
  /// It takes commands from now on. Returns the first ones.
  std::function<std::vector<Message>()> listens;
  /// It has ended, and all that it had started; all that it has said and reported was handed over
  /// before. The status is 128 + the signal where one killed it.
  std::function<void(int status)> ended;
};

/// The process of a module, and the next one where that has ended. It is used on the thread of a
/// loop; with the object the process is killed, with all that it has started.
class ModuleProcess {
 public:
  virtual ~ModuleProcess() = default;

  /// Starts a process, when none runs.
  /// @param control_uri  where it connects to for commands; empty: it takes none.
  ///
  /// Errors: NotFound, System (also: a name is in use).
  virtual Status start(const std::vector<std::string>& command, const std::string& control_uri) = 0;
  [[nodiscard]] virtual bool runs() const = 0;
  /// Asks it to end (SIGTERM).
  virtual void ask_to_end() = 0;
  /// Has it killed; `ended` says when that is done.
  virtual void kill() = 0;
  /// Looks whether it has ended, without waiting for the event.
  virtual void look() = 0;
  /// No process will follow soon: the names that readers of its outputs know are free.
  virtual void let_names_go() = 0;

  [[nodiscard]] virtual bool is_listening() const = 0;
  /// Sends it a command, if it is listening; false: it does not read them.
  virtual bool send(const Message& command) = 0;

  /// Its process number on its host; 0 where that is not known, or none runs.
  [[nodiscard]] virtual pid_t number() const = 0;
  /// What it and all that it has started use.
  /// @param with_memory  whether to look at the memory and at who has been started meanwhile.
  virtual internal::Usage usage(bool with_memory) = 0;
};

/// Processes of a module on this host.
/// @param manage_uri  where they report, listened to from now on.
/// @param key  descriptor that they get as kKeyDescriptor; -1: none.
///
/// Errors: Invalid, System (the name is in use).
Result<std::unique_ptr<ModuleProcess>> make_process_here(internal::Loop& loop,
                                                         const std::string& manage_uri, int key,
                                                         ModuleCallbacks callbacks);

/// Reads on this host in the place of a module that reads no more, so that no writer waits for it,
/// as long as the result.
/// @param reader_uri  the URI of its end; how long it was to wait plays no part, and it keeps no
///     message from being overwritten.
/// @param key  as above.
///
/// Errors: as open_source().
Result<std::shared_ptr<void>> read_in_place_here(internal::Loop& loop, std::string reader_uri,
                                                 int key);

}  // namespace hc
