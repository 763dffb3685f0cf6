// SPDX-License-Identifier: Apache-2.0
#include <hc/base/table_row.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

enum class Colour { Red, Green, Blue };

struct Spot {
  int id = 1;
  double u = 0;
  float angle = 0;
  bool is_lit = false;
  Colour colour = Colour::Red;
  [[nodiscard]] double twice() const { return 2 * u; }
};

struct SpotColumns {
  static void visit(auto& spot, auto&& column) {
    column("id", "", spot.id, 1.0);
    column("u", "px", spot.u);
    column("angle", "rad", spot.angle);
    column("lit", "", spot.is_lit, 0.0, 1.0);
    column("colour", "", spot.colour, 0.0, 2.0);
    column("twice", "", spot.twice());
  }
};

std::optional<Spot> read(std::span<const double> row) {
  return hc::read_row<SpotColumns, Spot>(row);
}

constexpr std::array<double, 6> kRow = {7, 12.35, 0.7854, 1, 2, 24.6914};

TEST(TableRow, has_its_names_with_units) {
  EXPECT_EQ((hc::column_names<SpotColumns, Spot>()),
            (std::vector<std::string>{"id", "u [px]", "angle [rad]", "lit", "colour", "twice"}));
}

TEST(TableRow, is_written_without_digits_that_mean_nothing) {
  std::array<double, 6> row{};
  hc::write_row<SpotColumns>(Spot{7, 12.345678, 0.78539816F, true, Colour::Blue}, row);
  EXPECT_EQ(row, kRow);
}

TEST(TableRow, is_read_as_it_was_written) {
  const auto spot = read(kRow);
  ASSERT_TRUE(spot);
  EXPECT_EQ(spot->id, 7);
  EXPECT_EQ(spot->u, 12.35);
  EXPECT_FLOAT_EQ(spot->angle, 0.7854F);
  EXPECT_TRUE(spot->is_lit);
  EXPECT_EQ(spot->colour, Colour::Blue);
}

TEST(TableRow, with_a_number_that_cannot_be_is_none) {
  EXPECT_FALSE(read(std::span(kRow).first(5)));
  EXPECT_FALSE(read({}));
  for (std::size_t column = 0; column < kRow.size(); ++column)
    for (const double wrong : {double(NAN), double(INFINITY), -1e300, 1.1e9}) {
      auto row = kRow;
      row[column] = wrong;
      EXPECT_FALSE(read(row)) << wrong << " in column " << column;
    }
  for (const auto& [column, wrong] :
       {std::pair(0, 0.0), {0, 1.5}, {3, 0.5}, {3, 2.0}, {4, 3.0}, {4, -1.0}}) {
    auto row = kRow;
    row[static_cast<std::size_t>(column)] = wrong;
    EXPECT_FALSE(read(row)) << wrong << " in column " << column;
  }
}

}  // namespace
