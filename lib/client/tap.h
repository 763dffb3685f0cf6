// SPDX-License-Identifier: Apache-2.0
#pragma once
// An output of a running graph, read without making any module wait: as a source, or on a thread of
// its own.

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

/// Opens an output of a running graph. The source outlives restarts of the module, and is at its
/// end when the graph is. A reader that is slow misses messages. The graph closes its end 5 s after
/// the last reader has left.
///
/// @param port  MODULE.PORT; of an input, what feeds it.
/// Errors: Invalid (there is no such port), as ask() and open_source().
Result<std::unique_ptr<Source>> open_tap(const RunningGraph& graph, const std::string& port,
                                         const LinkOptions& options = {});

/// Where such an output is read, for a program that opens it itself. Its reader is at its end as
/// its `reconnect` says, and not when the graph is.
Result<Uri> tap_uri(const RunningGraph& graph, const std::string& port, int stop = -1);

/// Reads an output on a thread of its own until it is destroyed, which waits for the callback that
/// runs. The thread yields the processor to the modules of the graph.
class Tap {
 public:
  using Clock = std::chrono::steady_clock;

  /// Called on the thread of the tap.
  struct Callbacks {
    /// The output is open.
    std::function<void()> open = [] {};
    /// A message; it is valid within the call, keep() holds it.
    std::function<void(const Message&)> message;
    /// No further message has arrived. @returns  when this is to be called again at the latest.
    std::function<Clock::time_point()> idle = [] { return Clock::time_point::max(); };
    /// The last call, unless it is destroyed before.
    /// @param is_error  there is no such output, or it failed; else the graph has ended.
    std::function<void(const std::string& why, bool is_error)> end;
  };

  /// Throws std::runtime_error, as the constructor of a thread does, where there is no descriptor
  /// or thread to be had.
  ///
  /// @param port  as of open_tap().
  Tap(RunningGraph graph, std::string port, Callbacks callbacks);
  ~Tap();
  Tap(const Tap&) = delete;
  Tap& operator=(const Tap&) = delete;

  /// Has `idle` called soon. From any thread.
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
