// SPDX-License-Identifier: Apache-2.0
// What counts as a face, with networks that say what the test tells them to; see
// face_finder_test.cpp for real ones.
#include <people/face_search.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <people/made_network_test.h>

namespace hc::people {
namespace {

using namespace std::chrono_literals;

constexpr hc::Time kStart(1'700'000'000s);

/// Outputs of a network with one face, around an anchor.
struct Outputs {
  Outputs(int anchors, int anchor, cv::Point2f middle, float side) : anchor(anchor) {
    numbers.create(anchors, 4 + 2 * static_cast<int>(Face::kPoints), CV_32F);
    numbers = 0;
    scores.create(anchors, 1, CV_32F);
    scores = -100;
    const float box[] = {middle.x, middle.y, side, side};
    std::copy(std::begin(box), std::end(box), numbers.ptr<float>(anchor));
  }
  void set_score(float score) { scores.at<float>(anchor) = std::log(score / (1 - score)); }

  int anchor;
  cv::Mat numbers, scores;
};

class FaceSearchRules : public ::testing::Test {
 protected:
  FaceFinder finder(int height, int width, const Outputs& outputs) {
    return *FaceFinder::make(std::make_unique<MadeNetwork>(
        nets::Shape{height, width, 3}, std::vector{outputs.numbers, outputs.scores}));
  }
  std::size_t look(Time time, float wide, float near) {
    wide_.set_score(wide);
    near_.set_score(near);
    return search_.look(time, image_).size();
  }

  // The large network sees a face 40 px wide; the small one, wherever it looks, one in the middle.
  Outputs wide_{48 * 64, 16 * 64 + 16, {0, 0}, 40}, near_{896, 272, {-4, -4}, 51.2F};
  FaceSearch search_{finder(192, 256, wide_), finder(128, 128, near_)};
  cv::Mat image_{192, 256, CV_8UC3, cv::Scalar::all(90)};
};

TEST_F(FaceSearchRules, the_small_network_must_be_surer_of_a_new_face_where_the_large_one_is_less) {
  struct Seen {
    float wide, near;
    std::size_t faces;
  };
  Time time = kStart;
  for (const auto& [wide, near, faces] :
       {Seen{0.6F, 0.6F, 0}, {0.4F, 0.75F, 0}, {0.2F, 0.95F, 0}, {0.6F, 0.7F, 1}})
    EXPECT_EQ(look(time += 1h, wide, near), faces) << wide << ' ' << near;
  EXPECT_EQ(look(time += 1h, 0.4F, 0.85F), 1U);
}

TEST_F(FaceSearchRules, a_face_that_is_followed_need_not_be_sure) {
  EXPECT_EQ(look(kStart, 0.6F, 0.7F), 1U);
  EXPECT_EQ(look(kStart + 50ms, 0.1F, 0.55F), 1U);
  EXPECT_EQ(look(kStart + 100ms, 0.1F, 0.45F), 0U);
}

}  // namespace
}  // namespace hc::people
