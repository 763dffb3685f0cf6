// SPDX-License-Identifier: Apache-2.0
#include "readable.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <hc/base/format.h>
#include <hc/base/visible.h>
#include <hc/mtp/coords.h>
#include <hc/mtp/matrix_view.h>
#include <hc/mtp/rows.h>

namespace tool {
namespace {

constexpr std::size_t kMostNumbers = 96;  // of a small matrix
constexpr std::size_t kCornerRows = 3, kCornerNumbers = 9;

template <typename T>
std::string rows_of(const hc::MatrixView<const T>& matrix) {
  bool whole = matrix.numbers().size() <= kMostNumbers;
  std::size_t rows = whole ? matrix.height() : std::min(kCornerRows, matrix.height());
  std::string text;
  for (std::size_t y = 0; y < rows; ++y) {
    auto row = matrix.row(y);
    std::size_t count = whole ? row.size() : std::min(kCornerNumbers, row.size());
    text += " ";
    for (std::size_t i = 0; i < count; ++i) {
      text += ' ';
      append_number(row[i], text);
    }
    text += count < row.size() ? " …\n" : "\n";
  }
  if (whole) return text;
  if (rows < matrix.height()) text += "  …\n";
  double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0;
  std::size_t known = 0;
  for (T number : matrix.numbers()) {
    auto value = static_cast<double>(number);
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
    ++known;
  }
  if (known > 0)
    text += hc::format("  {:g} … {:g}, mean {:g}\n", least, most, sum / static_cast<double>(known));
  return text;
}

}  // namespace

std::string time_in_words(hc::Time time) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(time - day);
  return hc::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}.{:09}", static_cast<int>(date.year()),
                    static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                    clock.hours().count(), clock.minutes().count(), clock.seconds().count(),
                    clock.subseconds().count());
}

std::string to_readable(const hc::Message& message) {
  const hc::Header& header = message.header;
  std::string text =
      hc::format("{}, src {} seq {}", matrix_text(header.info, header.width, header.height),
                 header.src, header.seq);
  if (header.dst != 0) text += hc::format(" dst {}", header.dst);
  if (header.mode != 0) text += hc::format(" mode {}", header.mode);
  if (header.coord != 0) text += " in " + hc::coord_text(header.coord);
  if (header.time != hc::Time()) text += " at " + time_in_words(header.time);
  text += "\n";
  if (!message.plain())
    return text +
           hc::format("  {} bytes of {}\n", message.elements.size(), name(header.info.encoding));
  if (header.empty()) return text;
  if (header.info.type == hc::MatrixType::String) {
    for (const auto& row : hc::rows_of(message)) text += "  " + hc::visible(row) + "\n";
    return text;
  }
  hc::visit_scalar(header.info.scalar,
                   [&](auto zero) { text += rows_of(*hc::view<decltype(zero)>(message)); });
  return text;
}

}  // namespace tool
