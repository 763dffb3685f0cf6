// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/trace.h>

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <hc/base/text.h>
#include <hc/mtp/rows.h>

namespace hc {
namespace {

constexpr std::array<std::string_view, 9> kWhats = {"took", "began", "ended",  "sent",    "lost",
                                                    "set",  "read",  "linked", "unlinked"};

bool is_of_link(TraceEvent::What what) {
  return what == TraceEvent::What::Linked || what == TraceEvent::What::Unlinked;
}
/// Whether an event is a change, with a value and without a message.
bool is_change(TraceEvent::What what) {
  return what == TraceEvent::What::Set || is_of_link(what);
}

/// The rest of the row of a change.
std::optional<TraceEvent> parse_change(TraceEvent event, std::string_view row) {
  std::int64_t moment = 0;
  if (is_of_link(event.what) && !read_number(take_until(row, ' '), event.seq)) return std::nullopt;
  if (!read_number(take_until(row, ' '), moment) || moment < 0) return std::nullopt;
  event.moment = unix_time(moment);
  event.value = row;
  return event;
}

std::optional<TraceEvent> parse_event(std::string_view row) {
  TraceEvent event;
  const auto what = enum_named<TraceEvent::What>(kWhats, take_until(row, ' '));
  if (!what) return std::nullopt;
  event.what = *what;
  event.port = take_until(row, ' ');
  if (is_change(*what)) return parse_change(std::move(event), row);
  if (event.port == "-") event.port.clear();
  auto take = [&](auto& number) { return read_number(take_until(row, ' '), number); };
  std::int64_t time = 0, moment = 0;
  const bool is_whole =
      take(event.src) && take(event.seq) && take(time) && take(moment) && time >= 0 && moment >= 0;
  event.time = unix_time(time);
  event.moment = unix_time(moment);
  const bool is_numbered = row.empty() || take(event.number);
  return is_whole && is_numbered && row.empty() ? std::optional(event) : std::nullopt;
}

}  // namespace

Message make_trace(std::span<const TraceEvent> events) {
  std::vector<std::string> rows;
  rows.reserve(events.size());
  for (const auto& event : events) {
    std::string& row = rows.emplace_back(kWhats[static_cast<std::size_t>(event.what)]);
    row.append(" ").append(event.port.empty() ? "-" : event.port);
    if (is_change(event.what)) {
      if (is_of_link(event.what)) row.append(" ").append(std::to_string(event.seq));
      row.append(" ").append(std::to_string(unix_nanoseconds(event.moment)));
      row.append(" ").append(event.value);
      continue;
    }
    for (const std::int64_t number : {std::int64_t{event.src}, event.seq,
                                      unix_nanoseconds(event.time), unix_nanoseconds(event.moment)})
      row.append(" ").append(std::to_string(number));
    if (event.number != 0) row.append(" ").append(std::to_string(event.number));
  }
  return make_rows(rows);
}

std::vector<TraceEvent> read_trace(const Message& message) {
  std::vector<TraceEvent> events;
  for (const auto& row : rows_of(message))
    if (auto event = parse_event(row)) events.push_back(std::move(*event));
  return events;
}

}  // namespace hc
