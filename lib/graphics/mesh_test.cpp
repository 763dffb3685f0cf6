// SPDX-License-Identifier: Apache-2.0
#include <graphics/mesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace hc::graphics {
namespace {

/// By the divergence theorem; negative if triangles are seen from inside.
double volume(const Mesh& mesh) {
  double six_fold = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      return mesh.vertices[mesh.indices[i + k]].position.cast<double>();
    };
    six_fold += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six_fold / 6;
}

TEST(Mesh, a_box_is_seen_from_outside) {
  EXPECT_NEAR(volume(make_box({1, 2, 3})), 6, 1e-5);
  for (const auto& vertex : make_box({1, 2, 3}).vertices)
    EXPECT_GT(vertex.normal.dot(vertex.position), 0);
}

TEST(Mesh, a_ball_nears_its_volume_from_below) {
  const double exact = 4.0 / 3 * std::numbers::pi * 0.125;
  EXPECT_LT(volume(make_ball(0.5, 24)), exact);
  EXPECT_GT(volume(make_ball(0.5, 24)), 0.98 * exact);
  for (const auto& vertex : make_ball(0.5).vertices) {
    EXPECT_NEAR(vertex.position.norm(), 0.5, 1e-6);
    EXPECT_NEAR((vertex.position.normalized() - vertex.normal).norm(), 0, 1e-5);
  }
}

TEST(Mesh, a_rectangle_looks_at_who_stands_before_it) {
  const Mesh mesh = make_rectangle(2, 1, {4, 2});
  for (const auto& vertex : mesh.vertices) {
    EXPECT_EQ(vertex.normal, Eigen::Vector3f(0, 0, -1));
    EXPECT_FLOAT_EQ(vertex.texture.x(), (vertex.position.x() / 2 + 0.5F) * 4);
    EXPECT_FLOAT_EQ(vertex.texture.y(), (vertex.position.y() + 0.5F) * 2);
  }
  // The winding of the triangles agrees with their normals.
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3f {
      return mesh.vertices[mesh.indices[i + k]].position;
    };
    EXPECT_LT((corner(1) - corner(0)).cross(corner(2) - corner(0)).z(), 0);
  }
}

}  // namespace
TEST(Mesh, keeps_its_shape_with_fewer_corners) {
  const Mesh fine = make_ball(1, 40), coarse = make_coarse(fine, 0.2F);
  EXPECT_LT(coarse.indices.size(), fine.indices.size() / 2);
  for (const auto& vertex : coarse.vertices) {
    EXPECT_NEAR(vertex.position.norm(), 1, 0.03);
    EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
  }
  for (const auto index : coarse.indices) EXPECT_LT(index, coarse.vertices.size());
}

}  // namespace hc::graphics
