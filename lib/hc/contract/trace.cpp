// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/trace.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include <hc/mtp/rows.h>

namespace hc {
namespace {

constexpr std::array<std::string_view, 5> kWhats = {"took", "began", "ended", "sent", "lost"};

std::string_view take_word(std::string_view& row) {
  const auto word = row.substr(0, row.find(' '));
  row.remove_prefix(std::min(row.size(), word.size() + 1));
  return word;
}

template <typename Number>
bool take_number(std::string_view& row, Number& number) {
  const auto word = take_word(row);
  const char* end = word.data() + word.size();
  const auto [stop, status] = std::from_chars(word.data(), end, number);
  return status == std::errc() && stop == end;
}

std::optional<TraceEvent> parse_event(std::string_view row) {
  TraceEvent event;
  const auto what = std::find(kWhats.begin(), kWhats.end(), take_word(row));
  if (what == kWhats.end()) return std::nullopt;
  event.what = static_cast<TraceEvent::What>(what - kWhats.begin());
  event.port = take_word(row);
  if (event.port == "-") event.port.clear();
  const bool is_whole = take_number(row, event.src) && take_number(row, event.seq) &&
                        take_number(row, event.time) && take_number(row, event.moment);
  const bool is_numbered = row.empty() || take_number(row, event.number);
  return is_whole && is_numbered && row.empty() ? std::optional(event) : std::nullopt;
}

}  // namespace

Message make_trace(std::span<const TraceEvent> events) {
  std::vector<std::string> rows;
  rows.reserve(events.size());
  for (const auto& event : events) {
    std::string& row = rows.emplace_back(kWhats[static_cast<std::size_t>(event.what)]);
    row.append(" ").append(event.port.empty() ? "-" : event.port);
    for (const std::int64_t number : {std::int64_t{event.src}, event.seq, event.time, event.moment})
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
