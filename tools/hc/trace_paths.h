// SPDX-License-Identifier: Apache-2.0
#pragma once
// From what modules tell of their messages (hc/contract/trace.h) to the paths of these through the
// graph: what a message was derived from, and how long each step took. Pure.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hc/contract/trace.h>

namespace tool {

/// What was reported, and by whom.
struct Traced {
  std::map<std::string, std::vector<hc::TraceEvent>> events;  ///< by module, in their order
  /// "MODULE.PORT", from and to; a URI is the world outside. Without any, a module that tells
  /// nothing is not passed.
  std::vector<std::pair<std::string, std::string>> links;
};

/// What a module had to do with a message, or with what it was derived from. [ns]
struct Step {
  std::string module;
  std::string in;               ///< empty: the message begins here, by its time
  std::string out;              ///< empty: the path ends here
  bool is_outside = false;      ///< the module reported nothing: all is `processing`
  std::int64_t link = 0;        ///< from the sender to the input, while the module was free
  std::int64_t waiting = 0;     ///< for the module, a partner message, or a timer that sends
  std::int64_t processing = 0;  ///< in handlers; of the first step from the message's time on

  /// What it sent has a time of its own: it was derived from what the module handled last.
  bool renews_time = false;

  [[nodiscard]] std::int64_t sum() const { return link + waiting + processing; }
  [[nodiscard]] std::string text() const;
};

/// The module of "MODULE.PORT".
std::string module_of(const std::string& port);

/// How a message came to be at the port that was asked for.
struct MessagePath {
  std::vector<Step> steps;  ///< first the step where it began
  std::int64_t age = 0;     ///< when taken by the input, or sent by the output [ns]
  std::int64_t total =
      0;  ///< the same from where the path begins; more, where a step renews the time
  bool is_critical = false;  ///< of the inputs of each step, the one that came last
};

/// The paths of all messages that were taken at an input, or sent by an output, "MODULE.PORT", as
/// far as they are known whole. At most `kMostPaths` of one message.
///
/// An output's message is derived from the last messages of the same time that its module took
/// before (R43); where there is none, it begins there. Only the module that sends what the port
/// takes, or whose output the port is, may have renewed the time, as controllers do: then the path
/// continues at the messages that it handled last within a second, of which the earliest sensed
/// is critical. Where the port is an input, what its module does with the message after
/// taking it is the last step, and no part of its age.
std::vector<MessagePath> find_paths(const Traced& traced, const std::string& port);
inline constexpr std::size_t kMostPaths = 64;

/// Of some durations. [ns]
struct Spread {
  std::int64_t median = 0, p99 = 0;
};
Spread spread_of(std::vector<std::int64_t> durations);

/// Messages that took the same way.
struct PathSummary {
  std::vector<Step> steps;  ///< their names
  struct Durations {
    Spread link, waiting, processing;
  };
  std::vector<Durations> durations;        ///< of each step
  Spread age, total;                       ///< as MessagePath
  std::size_t messages = 0, critical = 0;  ///< and of how many it was the critical path
};

/// Critical paths of the most messages first.
std::vector<PathSummary> summarise(const std::vector<MessagePath>& paths);

/// All that was reported as a trace of Chrome's JSON format, which Perfetto opens: a process for
/// each module, a slice for each handler, an arrow for each message.
std::string to_chrome_trace(const Traced& traced);

}  // namespace tool
