// SPDX-License-Identifier: Apache-2.0
#include <graph/run/reports.h>

#include <algorithm>
#include <utility>

#include <hc/base/uri.h>

namespace hc::internal {
namespace {

constexpr std::size_t kMaxKey = 4096;  // [byte]

/// Identifies an end of a link, without its options, which may change.
std::string end_key(const PlannedEnd& end) {
  std::string key = (end.is_input ? "in " : "out ") + end.port + " ";
  auto parsed = parse_uri(end.uri);
  if (!parsed) return key + end.uri;
  parsed->options.clear();
  return key + parsed->text();
}

/// Adds the counters of another link or process at the same end.
void add(const LinkCounters& row, LinkCounters& sum) {
  sum.traffic += row.traffic;
  sum.ignored += row.ignored;
  sum.quality = row.quality;
  sum.scale = row.scale;
  if (row.age.back() < sum.age.back()) return;
  sum.age = row.age;
  sum.gap = row.gap;
}

}  // namespace

/// Moves the current counters to the past ones.
void Reports::Counted::end() {
  add(std::exchange(now, {}), past);
  report.per_second = report.bytes_per_second = 0;
  arrived = MonotonicTime(0);
  past.age = past.gap = report.age = report.gap = {-1, -1, -1};
}

void Reports::set_ends(const std::vector<PlannedEnd>& ends) {
  auto before = std::exchange(ends_, {});
  std::vector<std::string> order;
  for (bool is_input : {true, false})
    for (const auto& end : ends) {
      if (end.is_input != is_input) continue;
      order.push_back(end_key(end));
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
    case Report::Log:
      return false;
    case Report::Counters:
      break;
  }
  // Programs with their own implementation of reports may leave src at 0.
  if (message.header.src <= static_cast<int>(Report::Counters))
    take_counters(read_counters(message), now);
  return false;
}

void Reports::take_counters(const std::vector<LinkCounters>& rows, MonotonicTime now) {
  if (rows.empty()) return;
  std::map<std::string, LinkCounters> sums;
  peers_.clear();
  for (std::size_t i = 0; i < std::min(rows.size(), order_.size()); ++i) {
    add(rows[i], sums[order_[i]]);
    peers_[order_[i]] = rows[i].peers;
  }
  for (auto& [key, counted] : ends_)
    if (auto sum = sums.find(key); sum != sums.end())
      count(counted, sum->second, key.starts_with("in "), now);
    else
      counted.report.per_second = counted.report.bytes_per_second = 0;
}

void Reports::count(Counted& counted, const LinkCounters& row, bool is_input, MonotonicTime now) {
  constexpr double kSilent = 5;      // then the rate is 0 [s]
  constexpr double kShortest = 0.1;  // least interval for a rate [s]
  const Traffic& traffic = row.traffic;
  if (traffic.messages < counted.now.traffic.messages) counted.end();  // the link was replaced
  const Traffic& before = counted.measured;
  EndReport report;
  report.per_second = counted.report.per_second;
  report.bytes_per_second = counted.report.bytes_per_second;
  const double seconds = std::chrono::duration<double>(now - counted.arrived).count();
  // A sender also counts messages that it drops.
  auto carried = [&](const Traffic& all) {
    return all.messages - (is_input ? 0 : std::min(all.messages, all.lost()));
  };
  const auto carried_now = carried(traffic);
  const auto messages = static_cast<double>(carried_now - std::min(carried_now, carried(before)));
  const auto bytes = static_cast<double>(traffic.bytes - std::min(traffic.bytes, before.bytes));
  const bool is_first = counted.arrived == MonotonicTime(0);
  if (is_first || (messages > 0 && seconds >= kShortest)) {
    report.per_second = is_first ? 0 : messages / seconds;
    report.bytes_per_second = is_first ? 0 : bytes / seconds;
    counted.arrived = now;
    counted.measured = traffic;
  } else if (messages == 0 && report.per_second * seconds > 1) {  // a message is overdue
    const double slower = seconds > kSilent ? 0 : 1 / (seconds * report.per_second);
    report.per_second *= slower;
    report.bytes_per_second *= slower;
  }
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
    order.push_back(end_key({link.is_input, link.port, link.uri, {}}).substr(0, kMaxKey));
  }
  has_links_ = true;
  for (auto& [key, counted] : ends_)
    if (std::find(order.begin(), order.end(), key) == order.end()) counted.end();
  return std::exchange(order_, order) != order;
}

bool Reports::take_state(const StateReport& state) {
  StateReport before = std::exchange(state_, state);
  before.blocked_row = state.blocked_row;  // not a change, as most blocks are short
  return before != state;
}

/// "out PORT URI"; empty: none, or unknown.
std::string Reports::blocked_key() const {
  const auto row = static_cast<std::size_t>(state_.blocked_row);
  return state_.blocked_row <= 0 || row > order_.size() ? "" : order_[row - 1];
}

bool Reports::is_open(const PlannedEnd& end) const {
  return !has_links_ || std::ranges::find(order_, end_key(end).substr(0, kMaxKey)) != order_.end();
}

std::int64_t Reports::peers_of(const PlannedEnd& end) const {
  const auto found = peers_.find(end_key(end));
  return found == peers_.end() ? -1 : found->second;
}

bool Reports::is_blocked_on(const PlannedLink& link) const {
  return !link.sender_uri.empty() && blocked_key() == end_key(link.end(false));
}

std::string Reports::blocked_output() const {
  const auto key = blocked_key();
  return key.starts_with("out ") ? key.substr(4, key.find(' ', 4) - 4) : "";
}

void Reports::end() {
  for (auto& [key, counted] : ends_) counted.end();
  has_links_ = false;
  state_.blocked_row = 0;
}

const EndReport* Reports::find(const PlannedEnd& end) const {
  auto found = ends_.find(end_key(end));
  return found == ends_.end() || !found->second.has_row ? nullptr : &found->second.report;
}

}  // namespace hc::internal
