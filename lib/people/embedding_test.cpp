// SPDX-License-Identifier: Apache-2.0
#include <people/embedding.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include <people/made_network_test.h>

namespace hc::people {
namespace {

TEST(Identifier, does_not_describe_a_face_by_numbers_that_are_none) {
  constexpr int kChip = 150, kCount = 128;
  cv::Mat numbers(1, kCount, CV_32F, cv::Scalar(0.1));
  auto identifier = Identifier::make(
      std::make_unique<MadeNetwork>(nets::Shape{kChip, kChip, 3}, std::vector{numbers}));
  ASSERT_TRUE(identifier);
  const cv::Mat image(60, 80, CV_8UC3, cv::Scalar::all(90));
  ASSERT_TRUE(identifier->describe(image, {}));
  EXPECT_EQ((*identifier->describe(image, {}))[kCount - 1], 0.1F);
  for (const float wrong : {NAN, INFINITY, -INFINITY, 1e30F}) {
    numbers.at<float>(kCount - 1) = wrong;
    EXPECT_FALSE(identifier->describe(image, {})) << wrong;
  }
}

}  // namespace
}  // namespace hc::people
