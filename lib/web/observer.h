// SPDX-License-Identifier: Apache-2.0
#pragma once
// An output of a running graph, read on a thread of its own without disturbing the graph: it yields
// the processor to the graph's modules.

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include <hc/observe/running.h>
#include <web/inbox.h>

namespace hc::web {

/// Reads an output until it is destroyed, which waits for the function that runs.
class Observer {
 public:
  using Clock = std::chrono::steady_clock;

  /// Called on the thread of the observer.
  struct Callbacks {
    /// The output is there.
    std::function<void()> open = [] {};
    /// A message; it is valid within the call, keep() holds it.
    std::function<void(const Message&)> message;
    /// No more messages are there now. @returns  when this is to be called again at the latest.
    std::function<Clock::time_point()> idle = [] { return Clock::time_point::max(); };
    /// The last that is called, unless it is destroyed before.
    /// @param is_error  there is no such output, or it failed; else the graph has ended.
    std::function<void(const std::string& why, bool is_error)> end;
  };

  /// @param port  MODULE.PORT; of an input, what feeds it.
  Observer(RunningGraph graph, std::string port, Callbacks callbacks);
  ~Observer();
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// Has `idle` called soon. From any thread.
  void wake();

 private:
  void run();
  void observe();

  const RunningGraph graph_;
  const std::string port_;
  const Callbacks callbacks_;
  internal::Event wake_ = internal::Event::must_make();
  std::atomic<bool> is_open_{false}, is_stopped_{false};
  std::thread thread_;
};

}  // namespace hc::web
