// SPDX-License-Identifier: Apache-2.0
#include <people/hand_landmarks.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <people/made_network_test.h>

namespace hc::people {
namespace {

constexpr int kSide = 224, kNumbers = 63;

TEST(HandLandmarks, that_are_no_hands_are_none) {
  std::vector<cv::Mat> said{
      cv::Mat(1, kNumbers, CV_32F, cv::Scalar(100)), cv::Mat(1, 1, CV_32F, cv::Scalar(0.9)),
      cv::Mat(1, 1, CV_32F, cv::Scalar(1)), cv::Mat(1, kNumbers, CV_32F, cv::Scalar(0.1))};
  auto landmarks =
      HandLandmarks::make(std::make_unique<MadeNetwork>(nets::Shape{kSide, kSide, 3}, said));
  ASSERT_TRUE(landmarks);
  const cv::Mat image(60, 80, CV_8UC3, cv::Scalar::all(90));
  const auto find = [&](const Region& region) { return landmarks->find(image, region); };
  const Region region{{40, 30}, 40, 0.3F};
  EXPECT_FLOAT_EQ(find(region).presence, 0.9F);
  for (const float wrong : {NAN, INFINITY, -INFINITY, 1e30F})
    for (const std::size_t output : {0U, 1U, 3U})
      for (int i = 0; i < static_cast<int>(said[output].total()); ++i) {
        if (output == 0 && i % 3 == 2) continue;  // depths are not used
        const float right = std::exchange(said[output].at<float>(i), wrong);
        const Hand hand = find(region);
        EXPECT_EQ(hand.presence, 0) << wrong << " in " << output << ", " << i;
        EXPECT_TRUE(std::ranges::all_of(hand.points, [](const auto& point) {
          return std::isfinite(point.x) && std::isfinite(point.y);
        }));
        said[output].at<float>(i) = right;
      }
  EXPECT_EQ(find({{40, 30}, 1e5F, 0}).presence, 0) << "far beyond the image";
}

}  // namespace
}  // namespace hc::people
