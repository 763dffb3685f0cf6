// SPDX-License-Identifier: Apache-2.0
#pragma once
// The interface to other hosts that run modules of a graph; lib/hosts implements it.

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

class Loop;
class ModuleProcess;
struct ModuleCallbacks;

/// A host that is connected or reconnecting.
class Host {
 public:
  virtual ~Host() = default;

  // For planning. Call these from threads other than the loop's; each call blocks until the host
  // answers or `stop` is readable. Errors: Closed (not connected), Stopped, and those of the
  // equivalent local functions.

  /// As find_program(), but a missing program is an error (NotFound).
  virtual Result<std::string> find_program(const std::string& name, int stop) = 0;
  /// As describe_program().
  virtual Result<std::string> describe_program(const std::string& program, int stop) = 0;
  /// As hc::hold_port(); the port survives a reconnection.
  virtual Result<std::shared_ptr<const HeldPort>> hold_port(bool of_all_addresses, int stop) = 0;
  /// Asks the agent about its host (`hc doctor`); question and answer are the program's own format.
  virtual Result<std::string> examine(const std::string& question, int stop) = 0;

  // For running the graph. Call these on the loop's thread; none blocks.

  [[nodiscard]] virtual HostPlace place() const = 0;
  [[nodiscard]] virtual HostState state() const = 0;
  /// Runs a module's processes there. If the connection is lost, they end with status kHostLost.
  virtual std::unique_ptr<ModuleProcess> make_process(const PlannedModule& module,
                                                      ModuleCallbacks callbacks) = 0;
  /// As read_in_place_here(), on that host.
  virtual std::shared_ptr<void> read_in_place(const std::string& reader_uri) = 0;
  /// A reserved port of all addresses, for observers. Errors: Closed.
  virtual Result<std::shared_ptr<const HeldPort>> spare_port() = 0;
  /// Add this to its monotonic clock to get the wall clock of this host.
  [[nodiscard]] virtual std::chrono::nanoseconds wall_offset() const = 0;

  /// Above the exit status of any process.
  static constexpr int kHostLost = 256;
};

/// The other hosts of a run and the connections to them. Used on the thread of one loop.
class Hosts {
 public:
  struct Connected {
    std::shared_ptr<Host> host;
    HostPlace place;
  };

  virtual ~Hosts() = default;

  /// The loop must turn while a host is connected: an agent ends after 3 s without a message.
  [[nodiscard]] virtual Loop& loop() = 0;
  /// Calls `work`, which may block on hosts, on another thread and turns the loop until it returns.
  /// Errors: System.
  virtual Status serve(const std::function<void()>& work) = 0;

  /// Returns the declared host; connects to a new one. Call this from threads other than the
  /// loop's. Errors: Closed (unreachable, or no compatible agent; the detail says why), Stopped.
  virtual Result<Connected> connect(const GraphHost& declared, int stop) = 0;
  /// A host returned by connect(); null if there is none of that name.
  [[nodiscard]] virtual std::shared_ptr<Host> find(const std::string& name) const = 0;

  /// The fingerprint of this host's key, and the descriptor of its file. Constant; any thread.
  [[nodiscard]] virtual std::string fingerprint() const = 0;
  [[nodiscard]] virtual int key() const = 0;

  /// Readable when there are events: a connection was lost or made, or a clock was set.
  [[nodiscard]] virtual int descriptor() const = 0;
  /// Returns the events as lines for the log.
  virtual std::vector<std::string> take_events() = 0;
};

}  // namespace hc
