// SPDX-License-Identifier: Apache-2.0
#pragma once
// Other hosts that modules of a graph run on, as the graph needs them. lib/hosts reaches them.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <graph/graph_file.h>
#include <graph/plan.h>
#include <hc/base/result.h>
#include <hc/contract/graph_state.h>

namespace hc {

namespace internal {
class Loop;
}
class ModuleProcess;
struct ModuleCallbacks;

/// A host that is connected, or is being connected to again.
class Host {
 public:
  virtual ~Host() = default;

  // For who plans: from other threads than the loop's, waiting for the host until `stop` is
  // readable. Errors: Closed (it is not connected), Stopped, and those of the functions of this
  // host.

  /// As find_program(), but a missing program is an error (NotFound).
  virtual Result<std::string> find_program(const std::string& name, int stop) = 0;
  /// As describe_program().
  virtual Result<std::string> describe_program(const std::string& program, int stop) = 0;
  /// As hc::hold_port(): for as long as the result, also when it is connected to again.
  virtual Result<std::shared_ptr<const HeldPort>> hold_port(bool of_all_addresses, int stop) = 0;
  /// What the program that runs there says of its host (`hc doctor`); words of its own.
  virtual Result<std::string> examine(const std::string& question, int stop) = 0;

  // For who runs the graph: on the loop's thread, at once.

  [[nodiscard]] virtual HostPlace place() const = 0;
  [[nodiscard]] virtual HostState state() const = 0;
  /// Processes of a module there. One that runs ends with status kHostLost when the connection
  /// does.
  virtual std::unique_ptr<ModuleProcess> make_process(const PlannedModule& module,
                                                      ModuleCallbacks callbacks) = 0;
  /// Has a reader there take the place of one that has ended, as long as the result.
  virtual std::shared_ptr<void> read_in_place(const std::string& reader_uri) = 0;
  /// A port of all addresses for who observes, where one is at hand. Errors: Closed.
  virtual Result<std::shared_ptr<const HeldPort>> spare_port() = 0;
  /// What added to its monotonic clock gives the wall clock here [ns].
  [[nodiscard]] virtual std::int64_t wall_offset() const = 0;

  /// Greater than the status of any process.
  static constexpr int kHostLost = 256;
};

/// All other hosts of a run, and the connections to them, on the thread of a loop.
class Hosts {
 public:
  struct Connected {
    std::shared_ptr<Host> host;
    HostPlace place;
  };

  virtual ~Hosts() = default;

  /// The loop, to be turned as long as a host is connected: one that hears nothing for 3 s gives
  /// us up.
  [[nodiscard]] virtual internal::Loop& loop() = 0;
  /// Does work that may wait for hosts, on another thread, while this one turns the loop. Errors:
  /// System.
  virtual Status serve(const std::function<void()>& work) = 0;

  /// The hosts of these declarations; those that are new are connected to, all at once. Errors: of
  /// each, Closed (it cannot be reached, or has no agent of ours; the detail says why), Stopped.
  /// From another thread than the loop's.
  virtual std::vector<Result<Connected>> connect(const std::vector<GraphHost>& declared,
                                                 int stop) = 0;
  /// A host that has been connected to; null: none has that name.
  [[nodiscard]] virtual std::shared_ptr<Host> find(const std::string& name) const = 0;

  /// Of the key of this host: its fingerprint, and its file. The same for life, from any thread.
  [[nodiscard]] virtual std::string fingerprint() const = 0;
  [[nodiscard]] virtual int key() const = 0;

  /// Readable when take_events() has something: a connection has been lost or made, or a clock has
  /// been set.
  [[nodiscard]] virtual int descriptor() const = 0;
  /// Lines for the log.
  virtual std::vector<std::string> take_events() = 0;
};

}  // namespace hc
