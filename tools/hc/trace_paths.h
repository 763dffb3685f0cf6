// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reconstructs the paths of messages through a graph from the traces of modules
// (hc/contract/trace.h): what a message was derived from, and how long each step took. Pure.

#include <chrono>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hc/contract/trace.h>

namespace tool {

using std::chrono::nanoseconds;

/// The traces of modules.
struct Traced {
  std::map<std::string, std::vector<hc::TraceEvent>> events;  ///< by module, in order
  /// "MODULE.PORT" or a URI, from and to. Without links, paths end at modules without a trace.
  std::vector<std::pair<std::string, std::string>> links;
};

/// The part of a path within one module.
struct Step {
  std::string module;
  std::string in;             ///< empty: the path begins here, at the message's time
  std::string out;            ///< empty: the path ends here
  bool is_outside = false;    ///< the module has no trace: all time is `processing`
  nanoseconds link{0};        ///< from the sender to the input, while the module was free
  nanoseconds waiting{0};     ///< for the module, a partner message, or a timer that sends
  nanoseconds processing{0};  ///< in handlers; in the first step since the message's time

  /// The message sent has a new time; it was derived from the messages handled last.
  bool renews_time = false;

  [[nodiscard]] std::string text() const;
};

/// The module of "MODULE.PORT".
std::string module_of(const std::string& port);

/// A path of a message to the port in question.
struct MessagePath {
  std::vector<Step> steps;   ///< from the origin
  nanoseconds age{0};        ///< of the message when taken by the input, or sent by the output
  nanoseconds total{0};      ///< time since the origin; more than `age` if a step renews the time
  bool is_critical = false;  ///< each step was entered by the input that came last
};

/// The complete paths of all messages taken at an input, or sent by an output, "MODULE.PORT"; at
/// most `kMostPaths` for each message.
///
/// A message is derived from the last messages of the same time that its module took before (R43);
/// if there are none, the path begins there. Only the module that owns the output, or sends to the
/// input, may have renewed the time, as controllers do: then the path continues at the messages
/// that it handled last within 1 s, and the one with the earliest time is critical. For an input,
/// the last step is its module's handling of the message, which is not part of its age.
std::vector<MessagePath> find_paths(const Traced& traced, const std::string& port);
inline constexpr std::size_t kMostPaths = 64;

/// Statistics of durations.
struct Spread {
  nanoseconds median{0}, p99{0};
};
Spread spread_of(std::vector<nanoseconds> durations);

/// Statistics of messages with the same path.
struct PathSummary {
  std::vector<Step> steps;  ///< only their names are valid
  struct Durations {
    Spread link, waiting, processing;
  };
  std::vector<Durations> durations;        ///< by step
  Spread age, total;                       ///< as in MessagePath
  std::size_t messages = 0, critical = 0;  ///< messages, and those with it as their critical path
};

/// Summaries, sorted by number of critical messages.
std::vector<PathSummary> summarise(const std::vector<MessagePath>& paths);

}  // namespace tool
