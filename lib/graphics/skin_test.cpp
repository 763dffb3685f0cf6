// SPDX-License-Identifier: Apache-2.0
#include <graphics/skin.h>

#include <gtest/gtest.h>

namespace hc::graphics {

namespace {

/// A strip along x of three corners: the first moves with the first bone, the last with the second.
Skin strip() {
  Skin skin;
  for (const float x : {0.0F, 1.0F, 2.0F})
    skin.mesh.vertices.push_back({{x, 0, 0}, Eigen::Vector3f::UnitY()});
  skin.mesh.indices = {0, 1, 2};
  skin.bones = {{"root", Eigen::Isometry3f::Identity()},
                {"tip", Eigen::Isometry3f(Eigen::Translation3f(1, 0, 0))}};
  skin.holds = {{{0, 1, 0, 0}, {1, 0, 0, 0}},
                {{0, 1, 0, 0}, {0.5F, 0.5F, 0, 0}},
                {{0, 1, 0, 0}, {0, 1, 0, 0}}};
  return skin;
}

TEST(Skin, is_as_it_was_with_its_bones_at_rest) {
  const Skin skin = strip();
  const std::array poses = {skin.bones[0].T_mesh_bone, skin.bones[1].T_mesh_bone};
  const Mesh mesh = posed(skin, poses);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_TRUE(mesh.vertices[i].position.isApprox(skin.mesh.vertices[i].position));
  EXPECT_EQ(mesh.indices, skin.mesh.indices);
}

TEST(Skin, follows_a_bone_that_turns_about_its_own_origin) {
  const Skin skin = strip();
  const Eigen::AngleAxisf quarter(1.5707963F, Eigen::Vector3f::UnitZ());
  const std::array poses = {skin.bones[0].T_mesh_bone, skin.bones[1].T_mesh_bone * quarter};
  const Mesh mesh = posed(skin, poses);
  EXPECT_TRUE(mesh.vertices[0].position.isZero());
  EXPECT_TRUE(mesh.vertices[1].position.isApprox(Eigen::Vector3f(1, 0, 0), 1e-5F));
  EXPECT_TRUE(mesh.vertices[2].position.isApprox(Eigen::Vector3f(1, 1, 0), 1e-5F));
  EXPECT_TRUE(mesh.vertices[2].normal.isApprox(-Eigen::Vector3f::UnitX(), 1e-5F));
}

TEST(Skin, of_bytes_that_are_no_model_is_malformed) {
  const std::array<std::byte, 4> bytes{};
  const auto skin = read_skin(bytes);
  ASSERT_FALSE(skin);
  EXPECT_EQ(skin.error().code, Code::Malformed);
}

}  // namespace

}  // namespace hc::graphics
