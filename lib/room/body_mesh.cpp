// SPDX-License-Identifier: Apache-2.0
#include <room/body_mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace hc::room {

namespace {

constexpr int kCorners = 10;

}  // namespace

graphics::Mesh make_skin(std::span<const Section> sections, const Eigen::Vector3f& colour) {
  constexpr double kRepeat = 0.3;  // [m]
  graphics::Mesh mesh;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Section& at = sections[i];
    const Section& above = sections[i == 0 ? 0 : i - 1];
    const Section& below = sections[std::min(i + 1, sections.size() - 1)];
    for (int corner = 0; corner <= kCorners; ++corner) {
      const double round = 2 * std::numbers::pi * corner / kCorners;
      const double c = std::cos(round), s = std::sin(round);
      auto point = [&](const Section& on) {
        return Eigen::Vector3d(on.middle_x + on.half_x * c, on.half_y * s, on.z);
      };
      const Eigen::Vector3d around(-at.half_x * s - 1e-6 * s, at.half_y * c + 1e-6 * c, 0);
      const Eigen::Vector3d normal = around.cross(point(above) - point(below)).normalized();
      mesh.vertices.push_back({point(at).cast<float>(),
                               normal.cast<float>(),
                               {static_cast<float>(round * (at.half_x + at.half_y) / 2 / kRepeat),
                                static_cast<float>(-at.z / kRepeat)},
                               colour});
    }
  }
  const auto rows = static_cast<std::uint32_t>(sections.size());
  constexpr auto kRow = static_cast<std::uint32_t>(kCorners + 1);
  for (std::uint32_t row = 0; row + 1 < rows; ++row)
    for (std::uint32_t corner = 0; corner + 1 < kRow; ++corner) {
      const auto a = row * kRow + corner, b = a + kRow;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  return mesh;
}

graphics::Mesh make_limb(double length, double first_radius, double last_radius,
                         const Eigen::Vector3f& colour) {
  constexpr int kCap = 2;
  std::vector<Section> sections;
  auto cap = [&](double middle, double radius, int step) {
    const double angle = std::numbers::pi / 2 * step / kCap;
    const double across = radius * std::cos(angle);
    sections.push_back({middle + radius * std::sin(angle), 0, across, across});
  };
  for (int step = kCap; step >= 0; --step) cap(length, last_radius, step);
  for (int step = 0; step >= -kCap; --step) cap(0, first_radius, step);
  return make_skin(sections, colour);
}

}  // namespace hc::room
