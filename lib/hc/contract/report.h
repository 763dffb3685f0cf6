// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a module reports to `hc run` over its --manage link: messages, written and read here alone
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

/// What a message reports, by its src.
/// Log: log_line.h.
enum class Report : std::int32_t { Counters = 1, Links, Parameters, State, Log };

/// Durations since the report before: median, 99th percentile, greatest [ns]; -1: none.
using Durations = std::array<std::int64_t, 3>;

/// What went over one link: a row of Report::Counters.
struct LinkCounters {
  Traffic traffic;
  std::uint64_t ignored = 0;  ///< messages that came and were not handled: not in focus
  Durations age{-1, -1, -1};  ///< of messages, from when they were sensed (R11)
  Durations gap{-1, -1, -1};  ///< from one message to the next
  std::int64_t peers = -1;    ///< that are connected; -1: unknown, or none ever is
};

/// The columns of Report::Counters, in this order.
struct CounterColumn {
  std::string_view name, meaning;
};
constexpr std::array<CounterColumn, 17> kCounterColumns = {{
    {"messages", "messages that went over the link"},
    {"bytes", "their bytes"},
    {"delayed", "messages delayed by `rate`; they went later, or are among the dropped"},
    {"dropped_newer", "dropped: a newer message arrived first (`keep`)"},
    {"throttled", "dropped while delayed by `rate`"},
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
}};

/// A table of i64, a row for each link.
Message make_counters(std::span<const LinkCounters> links);
/// The rows of a table of i64 of at least two columns; those that are missing are 0, or -1 for
/// durations. Nothing of any other message.
std::vector<LinkCounters> read_counters(const Message& message);

/// One end of a link: a row of Report::Links, in the order of the counters.
struct LinkEnd {
  bool is_input = true;
  std::string port, uri;
};
Message make_links(std::span<const LinkEnd> links);
/// Malformed rows are ignored.
std::vector<LinkEnd> read_links(const Message& message);

/// Report::Parameters: their values as text, by name. At most `max` are read.
Message make_parameters(const std::map<std::string, std::string>& values);
std::map<std::string, std::string> read_parameters(const Message& message, std::size_t max);

/// Report::State.
struct StateReport {
  std::int64_t mode = 0;   ///< of its messages; 0: none of its own
  std::int64_t focus = 0;  ///< the mode in focus, as last received or decided; 0: none
  bool in_focus = true;    ///< whether it works in that mode
  /// Row, from 1 on, of the link for whose reader it waits; 0: it does not.
  std::int64_t blocked_row = 0;
  Stops stops;  ///< of who decides on the focus
  bool operator==(const StateReport&) const = default;
};
Message make_state(const StateReport& state);
std::optional<StateReport> read_state(const Message& message);

}  // namespace hc
