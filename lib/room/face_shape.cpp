// SPDX-License-Identifier: Apache-2.0
#include <room/face_shape.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace hc::room {

namespace {

/// A value at a height [m].
struct At {
  double z, value;
};

// Read off the photograph, from the top of the hair to the chin.
constexpr At kWidths[] = {{0.126, 0},      {0.124, 0.02},   {0.118, 0.042},  {0.105, 0.068},
                          {0.085, 0.088},  {0.06, 0.1},     {0.03, 0.102},   {0, 0.096},
                          {-0.015, 0.086}, {-0.025, 0.079}, {-0.04, 0.068},  {-0.055, 0.061},
                          {-0.075, 0.056}, {-0.095, 0.044}, {-0.105, 0.034}, {-0.111, 0.02},
                          {-0.113, 0}};
// The face in front of the ears, and the back of the head behind them.
constexpr At kFronts[] = {{0.126, 0},      {0.118, 0.04},   {0.105, 0.062},  {0.085, 0.08},
                          {0.06, 0.092},   {0.03, 0.097},   {0, 0.091},      {-0.02, 0.094},
                          {-0.055, 0.096}, {-0.075, 0.096}, {-0.095, 0.093}, {-0.105, 0.083},
                          {-0.113, 0.055}};
constexpr At kBacks[] = {{0.126, 0},      {0.118, 0.04},  {0.105, 0.06},
                         {0.06, 0.092},   {0.02, 0.1},    {-0.03, 0.085},
                         {-0.055, 0.065}, {-0.075, 0.05}, {-0.113, 0.02}};
constexpr double kEyes = 0.088;  // in front of the ears [m]

double between(std::span<const At> table, double z) {
  for (std::size_t i = 1; i < table.size(); ++i) {
    const At &above = table[i - 1], &below = table[i];
    if (z >= below.z)
      return below.value + (above.value - below.value) *
                               std::clamp((z - below.z) / (above.z - below.z), 0.0, 1.0);
  }
  return table.back().value;
}

double bell(double x, double width) {
  return std::exp(-x * x / (2 * width * width));
}

/// How far the face is in front of the ears.
double front(double y, double z) {
  const double most = between(kFronts, z), width = half_width(z);
  // The face within the hair, which reaches less far forward.
  const double face_width = std::min(width, 0.075);
  auto round = [](double share, double power) {
    return std::pow(std::max(0.0, 1 - std::pow(std::abs(share), power)), 1 / power);
  };
  const double face = most * round(y / face_width, 2.2), hair = 0.6 * most * round(y / width, 2);
  const double smooth = 0.008, more = std::max(face, hair), less = std::min(face, hair);
  const double depth =
      more + smooth * std::log1p(std::exp((less - more) / smooth)) * std::min(1.0, more / 0.03);
  const double nose = 0.022 * bell(y, 0.009) * bell(z + 0.034, z > -0.034 ? 0.018 : 0.006);
  const double eye = -0.005 * bell(std::abs(y) - 0.0315, 0.012) * bell(z, 0.01);
  const double lips = 0.004 * bell(y, 0.02) * bell(z + 0.068, 0.009);
  return depth + nose + eye + lips;
}

Eigen::Vector3d place(double round, double z) {
  const double y = half_width(z) * std::sin(round);
  const double x = std::cos(round) >= 0 ? front(y, z) : between(kBacks, z) * std::cos(round);
  return {x - kEyes, y, z};
}

}  // namespace

double half_width(double z) {
  return between(kWidths, z);
}

graphics::Mesh make_head(const Look& look) {
  constexpr int kRows = 28, kColumns = 28;
  graphics::Mesh mesh;
  // Around the head, −0.5 … 0.5, closer to one another at the face.
  auto share_of = [](int column) {
    const double even = 2.0 * column / kColumns - 1;
    return 0.5 * (0.45 * even + 0.55 * even * even * even);
  };
  auto at = [&](int row, int column) -> Eigen::Vector3d {
    const double z = kHeadTop + (kHeadBottom - kHeadTop) * row / kRows;
    const double round = 2 * std::numbers::pi * share_of(column);
    const double jaw = 1 + (look.jaw - 1) * std::clamp((-0.03 - z) / 0.05, 0.0, 1.0);
    return place(round, std::clamp(z, kHeadBottom, kHeadTop))
        .cwiseProduct(Eigen::Vector3d(1, look.wide * jaw, look.high));
  };
  for (int row = 0; row <= kRows; ++row)
    for (int column = 0; column <= kColumns; ++column) {
      // Across the neighbours, which never coincide except at the two ends.
      const int above = std::max(row - 1, 0), below = std::min(row + 1, kRows);
      const Eigen::Vector3d along =
          at(row, (column + 1) % kColumns) - at(row, (column + kColumns - 1) % kColumns);
      Eigen::Vector3d normal = along.cross(at(above, column) - at(below, column));
      if (normal.norm() < 1e-9) normal = Eigen::Vector3d(0, 0, row == 0 ? 1 : -1);
      mesh.vertices.push_back(
          {at(row, column).cast<float>(),
           normal.normalized().cast<float>(),
           {static_cast<float>(share_of(column) + 0.5), static_cast<float>(row) / kRows}});
    }
  auto index = [](int row, int column) {
    return static_cast<std::uint32_t>(row * (kColumns + 1) + column);
  };
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const auto a = index(row, column), b = index(row + 1, column);
      const auto c = index(row + 1, column + 1), d = index(row, column + 1);
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  return mesh;
}

}  // namespace hc::room
