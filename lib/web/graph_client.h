// SPDX-License-Identifier: Apache-2.0
#pragma once
// The graph that the page shows: what it says of itself, and commands to it.

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <hc/mtp/message.h>
#include <hc/observe/running.h>

#include <web/inbox.h>

namespace hc::web {

class GraphClient {
 public:
  /// Called on the server's thread.
  struct Callbacks {
    std::function<void(const Message&)> message;  ///< a state or a line of the log, by its src
    std::function<void()> end;                    ///< the graph has ended
  };
  using Answered = std::function<void(const std::vector<std::string>& rows)>;

  GraphClient(RunningGraph graph, Post post, Callbacks callbacks);
  ~GraphClient();
  GraphClient(const GraphClient&) = delete;
  GraphClient& operator=(const GraphClient&) = delete;

  /// Has the graph do what a command says; commands are done one after the other.
  /// @param answered  called on the server's thread with "ok" and more rows, or with what is wrong.
  void command(std::string command, Answered answered);

 private:
  struct Asked {
    std::string command;
    Answered answered;
  };
  void survive(const std::function<void()>& work);
  void listen();
  void work();

  const RunningGraph graph_;
  const Post post_;
  const Callbacks callbacks_;
  internal::Event stop_ = internal::Event::must_make();
  std::mutex mutex_;
  std::condition_variable asked_;
  std::deque<Asked> commands_;
  bool is_stopped_ = false;
  std::thread listener_, asker_;
};

}  // namespace hc::web
