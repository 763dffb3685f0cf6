// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/reports.h>

#include <algorithm>
#include <utility>

#include <hc/base/uri.h>

namespace hc::internal {
namespace {

constexpr std::size_t kMostKey = 4096;  // of an end [byte]

/// The end of a link without its options: the same while its policy changes, and readers come and
/// go.
std::string end_key(bool is_input, const std::string& port, const std::string& uri) {
  std::string key = (is_input ? "in " : "out ") + port + " ";
  auto parsed = parse_uri(uri);
  if (!parsed) return key + uri;
  parsed->options.clear();
  return key + parsed->text();
}

/// Adds what another link, or process, of the same end has counted.
void add(const LinkCounters& row, LinkCounters& sum) {
  sum.traffic += row.traffic;
  sum.ignored += row.ignored;
  if (row.age.back() < sum.age.back()) return;
  sum.age = row.age;
  sum.gap = row.gap;
}

}  // namespace

/// Has what comes next count from 0.
void Reports::Counted::end() {
  add(std::exchange(now, {}), past);
  report.per_second = report.bytes_per_second = 0;
  past.age = past.gap = report.age = report.gap = {-1, -1, -1};
}

void Reports::set_ends(const std::vector<PlannedEnd>& ends) {
  auto before = std::exchange(ends_, {});
  std::vector<std::string> order;
  for (bool is_input : {true, false})
    for (const auto& end : ends) {
      if (end.is_input != is_input) continue;
      order.push_back(end_key(end.is_input, end.port, end.uri));
      ends_[order.back()] = before[order.back()];
    }
  if (!has_links_) order_ = std::move(order);
}

bool Reports::take(const Message& message, MonotonicTime now) {
  switch (static_cast<Report>(message.header.src)) {
    case Report::Links:
      return message.header.info.type == MatrixType::String && take_links(message);
    case Report::Parameters: {
      if (message.header.info.type != MatrixType::String) return false;
      auto parameters = read_parameters(message, kMostParameters);
      return std::exchange(parameters_, parameters) != parameters;
    }
    case Report::State: {
      const auto state = read_state(message);
      return state && take_state(*state);
    }
    case Report::Refusal:
      return false;
    case Report::Counters:
      break;
  }
  // A program that is no module of ours may leave src out.
  if (message.header.src <= static_cast<int>(Report::Counters))
    take_counters(read_counters(message), now);
  return false;
}

void Reports::take_counters(const std::vector<LinkCounters>& rows, MonotonicTime now) {
  if (rows.empty()) return;
  const double seconds =
      counted_ == MonotonicTime(0) ? 0 : std::chrono::duration<double>(now - counted_).count();
  counted_ = now;
  std::map<std::string, LinkCounters> sums;
  for (std::size_t i = 0; i < std::min(rows.size(), order_.size()); ++i)
    add(rows[i], sums[order_[i]]);
  for (const auto& [key, sum] : sums)
    if (auto found = ends_.find(key); found != ends_.end()) count(found->second, sum, seconds);
}

void Reports::count(Counted& counted, const LinkCounters& row, double seconds) {
  const Traffic &now = row.traffic, &before = counted.now.traffic;
  if (now.messages < before.messages) counted.end();  // the link was replaced
  auto per_second = [&](std::uint64_t after, std::uint64_t from) {
    return seconds > 0 ? static_cast<double>(after - std::min(after, from)) / seconds : 0;
  };
  EndReport report;
  report.per_second = per_second(now.messages, before.messages);
  report.bytes_per_second = per_second(now.bytes, before.bytes);
  counted.now = row;
  counted.has_row = true;
  add(counted.past, report);
  add(row, report);
  report.age = row.age;
  report.gap = row.gap;
  counted.report = report;
}

bool Reports::take_links(const Message& message) {
  std::vector<std::string> order;
  for (const auto& link : read_links(message)) {
    if (order.size() == kMostEnds) break;
    order.push_back(end_key(link.is_input, link.port, link.uri).substr(0, kMostKey));
  }
  has_links_ = true;
  for (auto& [key, counted] : ends_)
    if (std::find(order.begin(), order.end(), key) == order.end()) counted.end();
  return std::exchange(order_, order) != order;
}

bool Reports::take_state(const StateReport& state) {
  StateReport before = std::exchange(state_, state);
  before.awaits_reader = state.awaits_reader;  // tells only when it lasts
  return before != state;
}

void Reports::end() {
  for (auto& [key, counted] : ends_) counted.end();
  has_links_ = state_.awaits_reader = false;
  counted_ = MonotonicTime(0);
}

const EndReport* Reports::find(const PlannedEnd& end) const {
  auto found = ends_.find(end_key(end.is_input, end.port, end.uri));
  return found == ends_.end() || !found->second.has_row ? nullptr : &found->second.report;
}

}  // namespace hc::internal
