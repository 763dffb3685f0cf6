// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reports of a module to `hc run` over its --manage link: messages, written and read only here
// (spec/module.md). Pure.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/traffic.h>
#include <hc/contract/stops.h>
#include <hc/mtp/message.h>

namespace hc {

/// The kind of a report, its src. Log: see log_line.h.
enum class Report : std::int32_t { Counters = 1, Links, Parameters, State, Log };

/// Durations since the previous report: median, 99th percentile, maximum [ns]; -1: none.
using Durations = std::array<std::int64_t, 3>;

/// The counters of a link: a row of Report::Counters.
struct LinkCounters {
  Traffic traffic;
  std::uint64_t ignored = 0;  ///< received messages that were not handled: not in focus
  Durations age{-1, -1, -1};  ///< of messages, since the measurement (R11)
  Durations gap{-1, -1, -1};  ///< inter-arrival time
  std::int64_t peers = -1;    ///< connected peers; -1: unknown, or not applicable
  /// Of images that are adapted to a bandwidth: quality of JPEG, and scale [1/1000]; -1: none are.
  std::int64_t quality = -1, scale = -1;
};

/// The columns of Report::Counters, in order.
struct CounterColumn {
  std::string_view name, meaning;
};
constexpr std::array<CounterColumn, 19> kCounterColumns = {{
    {"messages", "messages that went over the link"},
    {"bytes", "their bytes"},
    {"delayed",
     "messages delayed by `rate` or `bandwidth`; they went later, or are among the dropped"},
    {"dropped_newer", "dropped: a newer message arrived first (`keep`)"},
    {"throttled", "dropped for `rate`, `bandwidth` or `idle_rate`"},
    {"dropped_memory", "dropped: no memory (`memory`)"},
    {"dropped_disconnect",
     "lost at a disconnect (`reconnect`, `stay`), or when the link was removed"},
    {"ignored", "received and not handled: another mode has the focus"},
    {"age_median", "age of messages, from when they were sensed (R11) [ns]"},
    {"age_p99", "its 99th percentile [ns]"},
    {"age_max", "its maximum [ns]"},
    {"gap_median", "time between messages [ns]"},
    {"gap_p99", "its 99th percentile [ns]"},
    {"gap_max", "its maximum [ns]"},
    {"dropped_timeout", "dropped: the reader had taken nothing for too long (`timeout`)"},
    {"bad", "received and dropped: damaged, or not what the input takes"},
    {"peers", "peers that are connected; -1: unknown, or of a file"},
    {"quality", "of JPEG, as images are adapted to `bandwidth`; -1: they are not"},
    {"scale", "of width and height, likewise [1/1000]"},
}};

/// A table of i64, one row per link.
Message make_counters(std::span<const LinkCounters> links);
/// The rows of a table of i64 with at least two columns; missing columns are 0, or -1 for
/// durations. Empty for other messages.
std::vector<LinkCounters> read_counters(const Message& message);

/// One end of a link: a row of Report::Links, in the same order as the counters.
struct LinkEnd {
  bool is_input = true;
  std::string port, uri;
};
Message make_links(std::span<const LinkEnd> links);
/// Malformed rows are ignored.
std::vector<LinkEnd> read_links(const Message& message);

/// Report::Parameters: values as text, by name. Reads at most `max`.
Message make_parameters(const std::map<std::string, std::string>& values);
std::map<std::string, std::string> read_parameters(const Message& message, std::size_t max);

/// Report::State.
struct StateReport {
  std::int64_t mode = 0;   ///< of its messages; 0: none
  std::int64_t focus = 0;  ///< the mode in focus, as last received or decided; 0: none
  bool in_focus = true;    ///< whether it is active in that mode
  /// Row, from 1, of the link whose reader blocks it; 0: not blocked.
  std::int64_t blocked_row = 0;
  Stops stops;  ///< of the module that decides on the focus
  bool operator==(const StateReport&) const = default;
};
Message make_state(const StateReport& state);
std::optional<StateReport> read_state(const Message& message);

}  // namespace hc
