// SPDX-License-Identifier: Apache-2.0
#include <room/face_shape.h>

#include <gtest/gtest.h>

#include <algorithm>

#include <room/face_paint.h>

namespace hc::room {

namespace {

TEST(FaceShape, has_the_eyes_at_the_origin_and_its_normals_outside) {
  for (int person = 0; person < kMostPeople; ++person) {
    const auto mesh = make_head(look_of(person));
    double nearest = 1;
    for (const auto& vertex : mesh.vertices) {
      nearest = std::min<double>(nearest, vertex.position.norm());
      EXPECT_NEAR(vertex.normal.norm(), 1, 1e-3);
      EXPECT_GE(vertex.texture.minCoeff(), 0);
      EXPECT_LE(vertex.texture.maxCoeff(), 1);
    }
    EXPECT_LT(nearest, 0.01);
    // The sum over all triangles is the volume inside, if their corners are counter-clockwise.
    double volume = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      auto at = [&](std::size_t corner) {
        return mesh.vertices[mesh.indices[i + corner]].position;
      };
      volume += static_cast<double>(at(0).dot(at(1).cross(at(2)))) / 6;
    }
    EXPECT_NEAR(volume, 0.0045, 0.0015) << person;  // 4.5 litres
  }
}

TEST(FacePaint, is_of_another_colour_for_each_person_and_the_same_each_time) {
  const cv::Mat first = paint_head(look_of(0)), again = paint_head(look_of(0));
  EXPECT_EQ(cv::norm(first, again, cv::NORM_INF), 0);
  for (int person = 1; person < kMostPeople; ++person) {
    const cv::Mat other = paint_head(look_of(person));
    ASSERT_EQ(other.size(), first.size());
    EXPECT_GT(cv::norm(first, other, cv::NORM_L1) / static_cast<double>(3 * first.total()), 10);
  }
}

}  // namespace

}  // namespace hc::room
