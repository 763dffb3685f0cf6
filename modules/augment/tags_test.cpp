// SPDX-License-Identifier: Apache-2.0
#include "tags.h"

#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "scene.h"

namespace {

/// With the default head: its left eye is at (0.06, 0.05, 1.25) m of the world and looks along x.
class TagsTest : public testing::Test {
 protected:
  void SetUp() override {
    make_scene("");
    hc::Header header;
    header.width = 800;
    header.height = 600;
    sight = Pair().at(header, {600, 600, 399.5, 299.5, 0.1}, frames);
    depth = cv::Mat::zeros(600, 800, CV_32F);
  }

  void make_scene(const std::string& objects) {
    scene.reset();
    auto renderer = hc::graphics::Renderer::make();
    ASSERT_TRUE(renderer) << renderer.error().text();
    auto made = Scene::make(objects, std::move(*renderer));
    ASSERT_TRUE(made) << made.error().text();
    scene = std::move(*made);
    scene->place(frames, {}, {});
  }

  /// Whose eyes are before the left eye, at its height. @param x  from there [m].
  [[nodiscard]] static NamedFace ahead(double x, const std::string& name = "Anna") {
    return {name, {0.06 + x, 0.05, 1.25}};
  }

  /// Opacity of the tags in an eye's image.
  cv::Mat draw(const std::vector<NamedFace>& faces, std::size_t eye = 0) {
    scene->tag(faces, sight);
    cv::Mat image(600, 800, CV_8UC3, cv::Scalar::all(100)), mask = cv::Mat::zeros(600, 800, CV_8U);
    const auto drawn = scene->draw(sight, eye, depth, image, &mask);
    EXPECT_TRUE(drawn) << drawn.error().text();
    last_image = image;
    return mask;
  }
  cv::Rect box(const std::vector<NamedFace>& faces, std::size_t eye = 0) {
    return cv::boundingRect(draw(faces, eye));
  }

  hc::Module module{"test", "A test."};
  hc::ModuleFrames frames{module, {.input = false}};
  std::unique_ptr<Scene> scene;
  Sight sight;
  cv::Mat depth, last_image;
};

TEST_F(TagsTest, are_over_the_head_and_smaller_further_away) {
  const cv::Rect near = box({ahead(1)}), far = box({ahead(2)});
  for (const auto& [tag, z] : {std::pair{near, 1.0}, std::pair{far, 2.0}}) {
    const double middle = tag.y + (tag.height - 1) / 2.0;
    EXPECT_NEAR(middle, 299.5 - 600 * Tags::kAbove / z, 1.5) << z;
    EXPECT_NEAR(tag.x + (tag.width - 1) / 2.0, 399.5, 1.5) << z;
  }
  EXPECT_NEAR(near.width / 2.0, far.width, 1.5);
  EXPECT_NEAR(near.height / 2.0, far.height, 1.5);
  EXPECT_GT(near.width, 2 * near.height);
}

TEST_F(TagsTest, have_letters_of_6_cm) {
  for (const double z : {1.0, 2.0}) {
    cv::Rect tag = box({ahead(z, "HHHH")});
    tag = {tag.x + 2, tag.y + 2, tag.width - 4, tag.height - 4};  // without its soft rim
    cv::Mat grey;
    cv::cvtColor(last_image(tag), grey, cv::COLOR_RGB2GRAY);
    double least = 0, most = 0;
    cv::minMaxLoc(grey, &least, &most);
    EXPECT_GT(most - least, 100) << "bright on dark";
    const cv::Rect letters = cv::boundingRect(grey > (least + most) / 2);
    EXPECT_NEAR(letters.height, 600 * 0.06 / z, 3) << z;
    EXPECT_GT(letters.y, 0) << z;
    EXPECT_LT(letters.br().y, tag.height) << z;
  }
}

TEST_F(TagsTest, have_the_disparity_of_their_depth) {
  for (const double z : {1.0, 2.0}) {
    const cv::Rect left = box({ahead(z)}, 0), right = box({ahead(z)}, 1);
    EXPECT_NEAR(left.x - right.x, 600 * 0.1 / z, 1.5);
    EXPECT_NEAR(left.br().x - right.br().x, 600 * 0.1 / z, 1.5);
    EXPECT_EQ(left.y, right.y);
    EXPECT_EQ(left.height, right.height);
  }
}

TEST_F(TagsTest, are_hidden_by_what_is_nearer) {
  const auto seen = [&](std::size_t eye) { return cv::Mat(draw({ahead(2)}, eye) > 127); };
  const double all = cv::countNonZero(seen(0));
  for (const std::size_t eye : {0U, 1U}) {
    for (const double z : {2.5, 2.0}) {  // at its depth the person is, too
      depth = z;
      EXPECT_NEAR(cv::countNonZero(seen(eye)), all, 0.05 * all) << z;
    }
    depth = 1.5;
    EXPECT_EQ(cv::countNonZero(seen(eye)), 0);
  }
  depth = 3;
  depth.colRange(0, 400) = 1.5;  // before its left half
  const cv::Mat mask = seen(0);
  EXPECT_EQ(cv::countNonZero(mask.colRange(0, 395)), 0);
  EXPECT_GT(cv::countNonZero(mask.colRange(405, 800)), 0.4 * all);
}

TEST_F(TagsTest, are_hidden_by_objects_that_are_nearer) {
  for (const auto& [distance, is_hidden] : {std::pair{"1.5", true}, {"2.5", false}}) {
    make_scene(std::string("cube at left_eye 0 -0.2 ") + distance + " size 0.5");
    draw({});
    const cv::Mat without = last_image;
    draw({ahead(2)});
    EXPECT_EQ(cv::norm(without, last_image, cv::NORM_INF) == 0, is_hidden) << distance;
    EXPECT_EQ(scene->bodies().size(), 1U) << "tags are no objects";
  }
}

TEST_F(TagsTest, face_the_eyes_wherever_they_are) {
  const double wide = box({ahead(2)}).width;
  const NamedFace aside{"Anna", {0.06 + 2, 0.05 + 1.1, 1.25}};
  // As wide as ahead at the same distance: the image stretches what is aside by 1 / cos twice.
  const double angle = std::atan2(1.1, 2.0), distance = std::hypot(2, 1.1);
  EXPECT_NEAR(box({aside}).width, wide * 2 / distance / std::pow(std::cos(angle), 2), 3);
}

TEST_F(TagsTest, are_none_where_nobody_is_or_can_be_seen) {
  EXPECT_GT(cv::countNonZero(draw({ahead(2)})), 0);
  EXPECT_TRUE(scene->is_seen(sight));
  for (const auto& faces :
       {std::vector<NamedFace>{}, {ahead(-2)}, {ahead(Tags::kNearest - 0.01)}}) {
    EXPECT_EQ(cv::countNonZero(draw(faces)), 0);
    EXPECT_FALSE(scene->is_seen(sight));
  }
}

TEST_F(TagsTest, of_other_names_look_otherwise) {
  const cv::Rect anna = box({ahead(1)});
  const cv::Mat seen = last_image(anna).clone();
  EXPECT_GT(box({ahead(1, "Annabella")}).width, 1.5 * anna.width);
  EXPECT_EQ(box({ahead(1)}), anna);
  EXPECT_EQ(cv::norm(seen, last_image(anna), cv::NORM_INF), 0);
  EXPECT_GT(box({ahead(1, "\u00c5sa")}).width, 0);
}

TEST_F(TagsTest, are_kept_for_few_names) {
  auto renderer = hc::graphics::Renderer::make();
  ASSERT_TRUE(renderer);
  Tags tags(**renderer);
  std::vector<NamedFace> faces;
  for (int i = 0; i < 10; ++i) {
    faces.assign(1, ahead(1));
    for (std::size_t k = 1; k < NamedFaces::kMostFaces; ++k)
      faces.push_back(ahead(1, std::to_string(100 * i) + " " + std::to_string(k)));
    tags.place(faces, sight);
    ASSERT_EQ(tags.bodies().size(), faces.size());
    ASSERT_LE(tags.plates(), Tags::kMostPlates);
    for (const auto& body : tags.bodies())
      ASSERT_LT(body.surfaces.front(), Tags::kMostPlates) << "their numbers are used again";
  }
}

}  // namespace
