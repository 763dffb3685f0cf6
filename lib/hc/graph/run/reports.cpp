// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/reports.h>

#include <algorithm>

#include <hc/wire/rows.h>

namespace hc::internal {
namespace {

constexpr std::size_t kTraffic = std::tuple_size_v<Counters>;
constexpr std::size_t kLeftOut = kTraffic, kAge = kLeftOut + 1, kGap = kAge + 3, kEnd = kGap + 3;
constexpr std::size_t kMostKey = 4096;  // of an end [byte]

}  // namespace

std::string end_key(bool is_input, const std::string& port, const std::string& uri) {
  std::string key = (is_input ? "in " : "out ") + port + " ";
  auto parsed = parse_uri(uri);
  if (!parsed) return key + uri;
  std::erase_if(parsed->options, [](const auto& option) { return option.first == "readers"; });
  return key + parsed->text();
}

void Reports::set_ends(const std::vector<PlannedEnd>& ends) {
  if (has_told_links_) return;
  order_.clear();
  for (bool is_input : {true, false})
    for (const auto& end : ends)
      if (end.is_input == is_input) order_.push_back(end_key(end.is_input, end.port, end.uri));
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
  for (std::size_t i = 0; i < std::min(rows.height(), order_.size()); ++i)
    if (ends_.size() < kMostEnds || ends_.contains(order_[i]))
      count(ends_[order_[i]], rows.row(i), seconds);
}

void Reports::count(Counted& counted, std::span<const std::int64_t> row, double seconds) {
  Counters counters{};
  std::copy_n(row.begin(), std::min(row.size(), counters.size()), counters.begin());
  Traffic now = traffic_of(counters);
  if (now.messages < counted.now.messages) {  // the link was made anew
    counted.past += counted.now;
    counted.past_left_out += counted.left_out_now;
    counted.now = {};
  }
  EndReport& report = counted.report;
  auto per_second = [&](std::uint64_t after, std::uint64_t before) {
    return seconds > 0 ? static_cast<double>(after - before) / seconds : 0;
  };
  report.per_second = per_second(now.messages, counted.now.messages);
  report.bytes_per_second = per_second(now.bytes, std::min(now.bytes, counted.now.bytes));
  counted.now = now;
  if (row.size() > kLeftOut) counted.left_out_now = static_cast<std::uint64_t>(row[kLeftOut]);
  report.traffic = counted.past;
  report.traffic += now;
  report.left_out = counted.past_left_out + counted.left_out_now;
  if (row.size() < kEnd) return;
  std::copy_n(row.begin() + kAge, report.age.size(), report.age.begin());
  std::copy_n(row.begin() + kGap, report.gap.size(), report.gap.begin());
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
  return before != std::tuple(mode, focus, in_focus);
}

void Reports::end() {
  for (auto& [key, counted] : ends_) {
    counted.past += std::exchange(counted.now, {});
    counted.past_left_out += std::exchange(counted.left_out_now, 0);
    counted.report.per_second = counted.report.bytes_per_second = 0;
    counted.report.age = counted.report.gap = {-1, -1, -1};
  }
  has_told_links_ = false;
  counted_ = MonotonicTime(0);
}

const EndReport* Reports::find(const PlannedEnd& end) const {
  auto found = ends_.find(end_key(end.is_input, end.port, end.uri));
  return found == ends_.end() ? nullptr : &found->second.report;
}

}  // namespace hc::internal
