// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/report.h>

#include <algorithm>
#include <tuple>

#include <hc/mtp/matrix_view.h>
#include <hc/mtp/rows.h>

namespace hc {
namespace {

using Row = std::array<std::int64_t, kCounterColumns.size()>;
using StateRow = std::array<std::int64_t, 4>;
constexpr std::size_t kIgnored = 7, kAge = kIgnored + 1, kGap = kAge + 3, kMore = kGap + 3;

/// The column of a traffic member: the last members were added after all other columns.
constexpr std::size_t column_of(std::size_t member) {
  return member < kIgnored ? member : kMore + member - kIgnored;
}
constexpr std::size_t kPeers = column_of(kTrafficMembers.size());
constexpr std::size_t kQuality = kPeers + 1, kScale = kQuality + 1;
static_assert(kScale + 1 == kCounterColumns.size());

template <std::size_t kColumns>
Message make_table(std::span<const std::array<std::int64_t, kColumns>> rows) {
  Draft draft = Draft::make({MatrixType::Table, kColumns, Scalar::I64, Encoding::Text},
                            static_cast<std::int32_t>(rows.size()), 1);
  auto table = view<std::int64_t>(draft);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy(rows[i].begin(), rows[i].end(), table.row(i).begin());
  return std::move(draft).finish();
}

LinkCounters counters_of(std::span<const std::int64_t> given) {
  Row row{};
  std::fill(row.begin() + kAge, row.begin() + kMore, -1);
  std::fill(row.begin() + kPeers, row.end(), -1);
  std::copy_n(given.begin(), std::min(given.size(), row.size()), row.begin());
  LinkCounters link;
  for (std::size_t i = 0; i < kTrafficMembers.size(); ++i)
    link.traffic.*kTrafficMembers[i] = static_cast<std::uint64_t>(row[column_of(i)]);
  link.ignored = static_cast<std::uint64_t>(row[kIgnored]);
  std::copy_n(row.begin() + kAge, link.age.size(), link.age.begin());
  std::copy_n(row.begin() + kGap, link.gap.size(), link.gap.begin());
  link.peers = row[kPeers];
  link.quality = row[kQuality];
  link.scale = row[kScale];
  return link;
}

}  // namespace

Message make_counters(std::span<const LinkCounters> links) {
  std::vector<Row> rows;
  for (const auto& link : links) {
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < kTrafficMembers.size(); ++i)
      row[column_of(i)] = static_cast<std::int64_t>(link.traffic.*kTrafficMembers[i]);
    row[kIgnored] = static_cast<std::int64_t>(link.ignored);
    std::copy(link.age.begin(), link.age.end(), row.begin() + kAge);
    std::copy(link.gap.begin(), link.gap.end(), row.begin() + kGap);
    row[kPeers] = link.peers;
    row[kQuality] = link.quality;
    row[kScale] = link.scale;
  }
  return make_table<kCounterColumns.size()>(rows);
}

std::vector<LinkCounters> read_counters(const Message& message) {
  std::vector<LinkCounters> links;
  const auto table = view<std::int64_t>(message);
  if (!table || table->empty() || table->width() != 1 || table->components() < 2) return links;
  for (std::size_t i = 0; i < table->height(); ++i) links.push_back(counters_of(table->row(i)));
  return links;
}

Message make_links(std::span<const LinkEnd> links) {
  std::vector<std::string> rows;
  for (const auto& link : links)
    rows.push_back((link.is_input ? "in " : "out ") + link.port + " " + link.uri);
  return make_rows(rows);
}

std::vector<LinkEnd> read_links(const Message& message) {
  std::vector<LinkEnd> links;
  for (const auto& row : rows_of(message)) {
    const auto port = row.find(' ');
    const auto uri = port == std::string::npos ? port : row.find(' ', port + 1);
    if (uri == std::string::npos) continue;
    links.push_back(
        {row.starts_with("in "), row.substr(port + 1, uri - port - 1), row.substr(uri + 1)});
  }
  return links;
}

Message make_parameters(const std::map<std::string, std::string>& values) {
  std::vector<std::string> rows;
  rows.reserve(values.size());
  for (const auto& [name, value] : values) rows.push_back(name + "=" + value);
  return make_rows(rows);
}

std::map<std::string, std::string> read_parameters(const Message& message, std::size_t max) {
  std::map<std::string, std::string> values;
  for (const auto& row : rows_of(message)) {
    const auto equals = row.find('=');
    if (values.size() == max) break;
    if (equals != std::string::npos) values[row.substr(0, equals)] = row.substr(equals + 1);
  }
  return values;
}

Message make_state(const StateReport& state) {
  std::vector<StateRow> rows = {
      {state.mode, state.focus, state.in_focus ? 1 : 0, state.blocked_row}};
  for (const auto& [source, is_stop] : state.stops) rows.push_back({source, is_stop ? 1 : 0, 0, 0});
  return make_table<std::tuple_size_v<StateRow>>(rows);
}

std::optional<StateReport> read_state(const Message& message) {
  const auto table = view<std::int64_t>(message);
  if (!table || table->empty()) return std::nullopt;
  const auto numbers = table->numbers();
  if (numbers.size() < 3) return std::nullopt;
  StateReport state{
      numbers[0], numbers[1], numbers[2] != 0, numbers.size() > 3 ? numbers[3] : 0, {}};
  for (std::size_t i = 1; i < table->height() && table->row(i).size() > 1; ++i)
    state.stops[static_cast<std::int32_t>(table->row(i)[0])] = table->row(i)[1] != 0;
  return state;
}

}  // namespace hc
