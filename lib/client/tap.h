// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads an output of a running graph without ever blocking a module: as a source, or on a thread.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <hc/contract/running_graph.h>
#include <hc/link/link.h>
#include <hc/os/event.h>

namespace hc {

/// Opens an output of a running graph. The source survives restarts of the module, and ends with
/// the graph. A slow reader misses messages. The graph closes the output 5 s after its last reader
/// has disconnected.
///
/// @param port  MODULE.PORT; for an input, the output linked to it.
/// Errors: Invalid (no such port), those of ask() and open_source().
Result<std::unique_ptr<Source>> open_tap(const RunningGraph& graph, const std::string& port,
                                         const LinkOptions& options = {});

/// The URI of such an output, for programs that open it themselves. That source does not end with
/// the graph, but as its `reconnect` says.
Result<Uri> tap_uri(const RunningGraph& graph, const std::string& port, int stop = -1);

/// The URI at which an input of a running graph takes messages. The graph closes it 5 s after its
/// last sender has disconnected.
///
/// @param port  MODULE.PORT. Errors: Invalid (no such input, or one that may move something without
/// the focus), those of ask().
Result<Uri> feed_uri(const RunningGraph& graph, const std::string& port, int stop = -1);

/// Reads an output on a thread until it is destroyed, which waits for a running callback. The
/// thread yields the processor to the graph's modules.
class Tap {
 public:
  using Clock = std::chrono::steady_clock;

  /// Called on the tap's thread.
  struct Callbacks {
    /// The output has been opened.
    std::function<void()> open = [] {};
    /// Takes a message, valid during the call; keep() makes it storable.
    std::function<void(const Message&)> message;
    /// No further message is waiting. @returns  when to call this again at the latest.
    std::function<Clock::time_point()> idle = [] { return Clock::time_point::max(); };
    /// The tap has ended; called once, unless it is destroyed first.
    /// @param is_error  the output does not exist or failed; otherwise the graph has ended.
    std::function<void(const std::string& why, bool is_error)> end;
  };

  /// Throws std::runtime_error if no descriptor, and std::system_error if no thread is available.
  ///
  /// @param port  as for open_tap().
  Tap(RunningGraph graph, std::string port, Callbacks callbacks);
  ~Tap();
  Tap(const Tap&) = delete;
  Tap& operator=(const Tap&) = delete;

  /// Makes the thread call `idle` soon. May be called on any thread.
  void wake();

 private:
  void run();
  void read();

  const RunningGraph graph_;
  const std::string port_;
  const Callbacks callbacks_;
  const Event wake_;
  std::atomic<bool> is_open_{false}, is_stopped_{false};
  std::thread thread_;
};

}  // namespace hc
