// SPDX-License-Identifier: Apache-2.0
#include <graphics/mesh.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

namespace hc::graphics {

void Mesh::append(const Mesh& other) {
  const auto begin = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto index : other.indices) indices.push_back(begin + index);
}

Mesh make_rectangle(float width, float height, const Eigen::Vector2f& repeat) {
  Mesh mesh;
  for (float y : {-1.0F, 1.0F})
    for (float x : {-1.0F, 1.0F})
      mesh.vertices.push_back({{x * width / 2, y * height / 2, 0},
                               {0, 0, -1},
                               {(x + 1) / 2 * repeat.x(), (y + 1) / 2 * repeat.y()}});
  mesh.indices = {0, 2, 1, 1, 2, 3};
  return mesh;
}

Mesh make_box(const Eigen::Vector3f& size) {
  // Rotate the rectangle's outward direction, −z, to that of each side.
  const std::array<Eigen::Vector3f, 6> directions = {
      Eigen::Vector3f::UnitX(), Eigen::Vector3f(-Eigen::Vector3f::UnitX()),
      Eigen::Vector3f::UnitY(), Eigen::Vector3f(-Eigen::Vector3f::UnitY()),
      Eigen::Vector3f::UnitZ(), Eigen::Vector3f(-Eigen::Vector3f::UnitZ())};
  Mesh mesh;
  for (const auto& outward : directions) {
    const auto turn = Eigen::Quaternionf::FromTwoVectors(-Eigen::Vector3f::UnitZ(), outward);
    Mesh side = make_rectangle(1, 1);
    for (auto& vertex : side.vertices) {
      vertex.position = (turn * vertex.position + outward / 2).cwiseProduct(size);
      vertex.normal = outward;
    }
    mesh.append(side);
  }
  return mesh;
}

Mesh make_ball(float radius, int rings) {
  using std::numbers::pi_v;
  Mesh mesh;
  const int corners = 2 * rings;
  for (int ring = 0; ring <= rings; ++ring)
    for (int corner = 0; corner <= corners; ++corner) {
      const float u = static_cast<float>(corner) / static_cast<float>(corners);
      const float v = static_cast<float>(ring) / static_cast<float>(rings);
      const float round = 2 * pi_v<float> * u, down = pi_v<float> * v;
      const Eigen::Vector3f normal(std::sin(down) * std::cos(round),
                                   std::sin(down) * std::sin(round), std::cos(down));
      mesh.vertices.push_back({radius * normal, normal, {u, v}});
    }
  auto index = [&](int ring, int corner) {
    return static_cast<std::uint32_t>(ring * (corners + 1) + corner);
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int corner = 0; corner < corners; ++corner) {
      const auto a = index(ring, corner), b = index(ring + 1, corner);
      const auto c = index(ring + 1, corner + 1), d = index(ring, corner + 1);
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  return mesh;
}

Mesh make_coarse(const Mesh& mesh, float cell) {
  Mesh coarse;
  std::map<std::array<int, 3>, std::uint32_t> cells;
  std::vector<std::uint32_t> merged;
  std::vector<float> counts;
  for (const auto& vertex : mesh.vertices) {
    const Eigen::Vector3i at = (vertex.position / cell).array().floor().cast<int>();
    const auto next = static_cast<std::uint32_t>(coarse.vertices.size());
    const auto [known, is_new] = cells.try_emplace({at.x(), at.y(), at.z()}, next);
    merged.push_back(known->second);
    if (is_new) {
      coarse.vertices.push_back(vertex);
      counts.push_back(1);
      continue;
    }
    Vertex& sum = coarse.vertices[known->second];
    sum.position += vertex.position;
    sum.normal += vertex.normal;
    sum.texture += vertex.texture;
    sum.colour += vertex.colour;
    ++counts[known->second];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    Vertex& sum = coarse.vertices[i];
    sum.position /= counts[i];
    sum.normal.normalize();
    sum.texture /= counts[i];
    sum.colour /= counts[i];
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto a = merged[mesh.indices[i]], b = merged[mesh.indices[i + 1]],
               c = merged[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) coarse.indices.insert(coarse.indices.end(), {a, b, c});
  }
  return coarse;
}

}  // namespace hc::graphics
