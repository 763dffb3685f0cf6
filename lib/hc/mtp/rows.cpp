// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/rows.h>

#include <algorithm>

namespace hc {

Message make_rows(std::span<const std::string> lines) {
  std::size_t width = 0;
  for (const auto& line : lines) width = std::max(width, line.size());
  Draft draft = Draft::make({MatrixType::String, 1, Scalar::U8, Encoding::Binary}, static_cast<std::int32_t>(width == 0 ? 0 : lines.size()), static_cast<std::int32_t>(width));
  auto place = draft.elements().begin();
  for (const auto& line : lines) {
    place = std::transform(line.begin(), line.end(), place,
                           [](char c) { return static_cast<std::byte>(c); });
    place = std::fill_n(place, width - line.size(), std::byte{' '});
  }
  return std::move(draft).finish();
}

std::vector<std::string> rows_of(const Message& message) {
  std::vector<std::string> rows;
  if (message.header.info.type != MatrixType::String || message.header.empty() || !message.plain())
    return rows;
  auto characters = message.text();
  const auto width = static_cast<std::size_t>(message.header.width);
  for (std::size_t at = 0; at < characters.size(); at += width) {
    auto row = characters.substr(at, width);
    rows.emplace_back(row.substr(0, row.find_last_not_of(' ') + 1));
  }
  return rows;
}

}  // namespace hc
