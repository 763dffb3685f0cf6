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

class Loop;
class ModuleProcess;
struct ModuleCallbacks;

/// A host that is connected, or is being connected to again.
class Host {
 public:
  virtual ~Host() = default;

  // For planning. To be called from threads other than the loop's; each call waits for the host
  // until `stop` is readable. Errors: Closed (it is not connected), Stopped, and those of the
  // functions of this host.

  /// As find_program(), but a missing program is an error (NotFound).
  virtual Result<std::string> find_program(const std::string& name, int stop) = 0;
  /// As describe_program().
  virtual Result<std::string> describe_program(const std::string& program, int stop) = 0;
  /// As hc::hold_port(): for as long as the result, also when it is connected to again.
  virtual Result<std::shared_ptr<const HeldPort>> hold_port(bool of_all_addresses, int stop) = 0;
  /// What the program that runs there says of its host (`hc doctor`); words of its own.
  virtual Result<std::string> examine(const std::string& question, int stop) = 0;

  // For running the graph. To be called on the loop's thread; no call waits.

  [[nodiscard]] virtual HostPlace place() const = 0;
  [[nodiscard]] virtual HostState state() const = 0;
  /// Runs the processes of a module there. When the connection is lost they end with status
  /// kHostLost.
  virtual std::unique_ptr<ModuleProcess> make_process(const PlannedModule& module,
                                                      ModuleCallbacks callbacks) = 0;
  /// As read_in_place_here(), there.
  virtual std::shared_ptr<void> read_in_place(const std::string& reader_uri) = 0;
  /// A port of all addresses for observers, if one is held in reserve. Errors: Closed.
  virtual Result<std::shared_ptr<const HeldPort>> spare_port() = 0;
  /// What added to its monotonic clock gives the wall clock here [ns].
  [[nodiscard]] virtual std::int64_t wall_offset() const = 0;

  /// Greater than the status of any process.
  static constexpr int kHostLost = 256;
};

/// All other hosts of a run, and the connections to them. Used on the thread of one loop.
class Hosts {
 public:
  struct Connected {
    std::shared_ptr<Host> host;
    HostPlace place;
  };

  virtual ~Hosts() = default;

  /// The loop, which must turn while a host is connected: an agent that hears nothing for 3 s
  /// ends.
  [[nodiscard]] virtual Loop& loop() = 0;
  /// Calls `work`, which may wait for hosts, on another thread, and turns the loop until it
  /// returns. Errors: System.
  virtual Status serve(const std::function<void()>& work) = 0;

  /// The host of this declaration; a new one is connected to. To be called from threads other than
  /// the loop's. Errors: Closed (it cannot be reached, or has no agent of ours; the detail says
  /// why), Stopped.
  virtual Result<Connected> connect(const GraphHost& declared, int stop) = 0;
  /// A host that has been connected to; null: none has that name.
  [[nodiscard]] virtual std::shared_ptr<Host> find(const std::string& name) const = 0;

  /// The fingerprint of the key of this host, and its file. Constant; for any thread.
  [[nodiscard]] virtual std::string fingerprint() const = 0;
  [[nodiscard]] virtual int key() const = 0;

  /// Readable when take_events() has something: a connection has been lost or made, or a clock has
  /// been set.
  [[nodiscard]] virtual int descriptor() const = 0;
  /// Lines for the log.
  virtual std::vector<std::string> take_events() = 0;
};

}  // namespace hc
