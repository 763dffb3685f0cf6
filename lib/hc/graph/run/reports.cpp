// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/reports.h>

#include <algorithm>

#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

constexpr std::size_t kTraffic = std::tuple_size_v<Counters>;
constexpr std::size_t kLeftOut = kTraffic, kAge = kLeftOut + 1, kGap = kAge + 3, kEnd = kGap + 3;
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

/// Adds a row of counters to what others say of the same end.
void add_row(std::span<const std::int64_t> row, EndReport& sum) {
  Counters counters{};
  std::copy_n(row.begin(), std::min(row.size(), counters.size()), counters.begin());
  sum.traffic += traffic_of(counters);
  if (row.size() > kLeftOut) sum.left_out += static_cast<std::uint64_t>(row[kLeftOut]);
  if (row.size() < kEnd || row[kGap - 1] < sum.age.back()) return;  // the others' are greater
  std::copy_n(row.begin() + kAge, sum.age.size(), sum.age.begin());
  std::copy_n(row.begin() + kGap, sum.gap.size(), sum.gap.begin());
}

}  // namespace

/// Has what comes next count from 0.
void Reports::Counted::end() {
  past += std::exchange(now, {});
  past_left_out += std::exchange(left_out_now, 0);
  report.per_second = report.bytes_per_second = 0;
  report.age = report.gap = {-1, -1, -1};
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
  if (!has_told_links_) order_ = std::move(order);
}

bool Reports::take(const Message& message, MonotonicTime now) {
  if (message.header.src == kLinks && message.header.info.type == MatrixType::String)
    return take_links(message);
  if (message.header.src == kParameters && message.header.info.type == MatrixType::String)
    return take_parameters(message);
  auto rows = message.view<std::int64_t>();
  if (!rows || rows->empty()) return false;
  if (message.header.src == kState) return take_state(*rows);
  // A program that is no module of ours may leave src out.
  if (message.header.src <= kCounters && rows->width() == 1 && rows->components() >= 2)
    take_counters(*rows, now);
  return false;
}

void Reports::take_counters(const MatrixView<const std::int64_t>& rows, MonotonicTime now) {
  const double seconds =
      counted_ == MonotonicTime(0) ? 0 : std::chrono::duration<double>(now - counted_).count();
  counted_ = now;
  std::map<std::string, EndReport> sums;
  for (std::size_t i = 0; i < std::min(rows.height(), order_.size()); ++i)
    add_row(rows.row(i), sums[order_[i]]);
  for (const auto& [key, sum] : sums)
    if (auto found = ends_.find(key); found != ends_.end()) count(found->second, sum, seconds);
}

void Reports::count(Counted& counted, const EndReport& row, double seconds) {
  const Traffic& now = row.traffic;
  if (now.messages < counted.now.messages) counted.end();  // the link was made anew
  EndReport& report = counted.report;
  auto per_second = [&](std::uint64_t after, std::uint64_t before) {
    return seconds > 0 ? static_cast<double>(after - before) / seconds : 0;
  };
  report.per_second = per_second(now.messages, counted.now.messages);
  report.bytes_per_second = per_second(now.bytes, std::min(now.bytes, counted.now.bytes));
  counted.now = now;
  counted.left_out_now = row.left_out;
  counted.is_told = true;
  report.traffic = counted.past;
  report.traffic += now;
  report.left_out = counted.past_left_out + counted.left_out_now;
  report.age = row.age;
  report.gap = row.gap;
}

bool Reports::take_links(const Message& message) {
  std::vector<std::string> order;
  for (const auto& row : rows_of(message)) {
    auto port = row.find(' ');
    auto uri = port == std::string::npos ? port : row.find(' ', port + 1);
    if (uri == std::string::npos) continue;
    if (order.size() == kMostEnds) break;
    order.push_back(
        end_key(row.starts_with("in "), row.substr(port + 1, uri - port - 1), row.substr(uri + 1))
            .substr(0, kMostKey));
  }
  has_told_links_ = true;
  for (auto& [key, counted] : ends_)
    if (std::find(order.begin(), order.end(), key) == order.end()) counted.end();
  return std::exchange(order_, order) != order;
}

bool Reports::take_parameters(const Message& message) {
  std::map<std::string, std::string> parameters;
  for (const auto& row : rows_of(message)) {
    auto equals = row.find('=');
    if (parameters.size() == kMostParameters) break;
    if (equals != std::string::npos) parameters[row.substr(0, equals)] = row.substr(equals + 1);
  }
  return std::exchange(parameters_, parameters) != parameters;
}

bool Reports::take_state(const MatrixView<const std::int64_t>& rows) {
  auto numbers = rows.numbers();
  if (numbers.size() < 3) return false;
  auto before = std::tuple(mode, focus, in_focus);
  mode = numbers[0];
  focus = numbers[1];
  in_focus = numbers[2] != 0;
  awaits_reader = numbers.size() > 3 && numbers[3] != 0;
  return before != std::tuple(mode, focus, in_focus);
}

void Reports::end() {
  for (auto& [key, counted] : ends_) counted.end();
  has_told_links_ = awaits_reader = false;
  counted_ = MonotonicTime(0);
}

const EndReport* Reports::find(const PlannedEnd& end) const {
  auto found = ends_.find(end_key(end.is_input, end.port, end.uri));
  return found == ends_.end() || !found->second.is_told ? nullptr : &found->second.report;
}

}  // namespace hc::internal
