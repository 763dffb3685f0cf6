// SPDX-License-Identifier: Apache-2.0
#pragma once
// Rows of tables as structs, whose columns are listed once, in their order. Pure. Header only.
//
//     struct Pixel {
//       int id = 0;
//       double u = 0;
//     };
//     struct PixelColumns {
//       static void visit(auto& row, auto&& column) {
//         column("id", "", row.id, 1.0);  // from 1
//         column("u", "px", row.u);
//       }
//     };
//     hc::write_row<PixelColumns>(pixel, numbers);
//     const auto pixel = hc::read_row<PixelColumns, Pixel>(numbers);

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hc/base/check.h>

namespace hc {

/// Rounded to 0.01 of a pixel, or to 0.0001 of another unit: further digits mean nothing.
inline double rounded(double number, std::string_view unit = "") {
  const double steps = unit == "px" ? 100 : 10'000;
  return std::round(number * steps) / steps;
}

/// Largest magnitude of a number that is read from a row: an int holds it.
inline constexpr double kMostInRow = 1e9;

/// The names of the columns, with their units: "u [px]".
template <typename Columns, typename Row>
std::vector<std::string> column_names() {
  std::vector<std::string> names;
  Row row;
  Columns::visit(row, [&](std::string_view name, std::string_view unit, auto&&...) {
    names.emplace_back(name);
    if (!unit.empty()) names.back().append(" [").append(unit).append("]");
  });
  return names;
}

/// Writes a row, rounded.
///
/// @param[out] to  as many numbers as there are columns.
template <typename Columns, typename Row>
void write_row(const Row& row, std::span<double> to) {
  std::size_t next = 0;
  Columns::visit(row, [&](std::string_view, std::string_view unit, const auto& value, auto...) {
    HC_CHECK(next < to.size(), to.size());
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>)
      to[next++] = rounded(static_cast<double>(value), unit);
    else
      to[next++] = static_cast<double>(value);
  });
  HC_CHECK(next == to.size(), to.size());
}

/// Reads a row. Computed columns are checked, and not stored.
///
/// @returns nothing if it has too few numbers, or one that is NaN, infinite, outside its limits, or
/// no whole number where the member is one (int, bool, enum).
template <typename Columns, typename Row>
std::optional<Row> read_row(std::span<const double> from) {
  Row row;
  std::size_t next = 0;
  bool is_row = true;
  const auto take = [&](auto& value, double least, double most) {
    using Value = std::remove_reference_t<decltype(value)>;
    const double number = next < from.size() ? from[next] : NAN;
    ++next;
    is_row &= number >= least && number <= most;
    if constexpr (!std::is_floating_point_v<Value>) is_row &= number == std::floor(number);
    if constexpr (!std::is_const_v<Value>)
      if (is_row) value = static_cast<Value>(number);
  };
  Columns::visit(row, [&](std::string_view, std::string_view, auto&& value,
                          double least = -kMostInRow, double most = kMostInRow) {
    if constexpr (std::is_lvalue_reference_v<decltype(value)>)
      take(value, least, most);
    else
      take(std::as_const(value), least, most);
  });
  return is_row ? std::optional(row) : std::nullopt;
}

}  // namespace hc
