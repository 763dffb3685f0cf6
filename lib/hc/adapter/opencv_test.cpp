// SPDX-License-Identifier: Apache-2.0
#include <hc/adapter/opencv.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(OpenCv, SharesElementsBothWays) {
  Draft draft = Draft::make({MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}, 4, 2);
  cv::Mat made = *as_mat(draft);
  made.setTo(cv::Scalar(1, 2, 3));
  made.at<cv::Vec3b>(1, 3) = {7, 8, 9};
  Message message = std::move(draft).finish();
  cv::Mat seen = *as_mat(message);
  EXPECT_EQ(static_cast<const void*>(seen.data), message.elements.data());
  EXPECT_EQ(seen.rows, 2);
  EXPECT_EQ(seen.cols, 4);
  EXPECT_EQ(seen.at<cv::Vec3b>(1, 3), cv::Vec3b(7, 8, 9));
  EXPECT_EQ(message.view<std::uint8_t>()->at(1, 3, 2), 9);
}

TEST(OpenCv, HasTheDepthOfEachScalarThatItKnows) {
  const std::pair<Scalar, int> depths[] = {
      {Scalar::U8, CV_8U},   {Scalar::I8, CV_8S},   {Scalar::U16, CV_16U}, {Scalar::I16, CV_16S},
      {Scalar::I32, CV_32S}, {Scalar::F32, CV_32F}, {Scalar::F64, CV_64F}};
  for (const auto& [scalar, depth] : depths) EXPECT_EQ(*cv_depth(scalar), depth);
  for (Scalar scalar : {Scalar::U32, Scalar::U64, Scalar::I64})
    EXPECT_EQ(cv_depth(scalar).error().code, Code::Unsupported);
  Draft draft = Draft::make({MatrixType::Table, 1, Scalar::U32, Encoding::Text}, 1, 1);
  EXPECT_FALSE(as_mat(draft));
}

TEST(OpenCv, CompressedIsRefused) {
  Message message =
      std::move(Draft::make({MatrixType::Table, 1, Scalar::U8, Encoding::Text}, 1, 1)).finish();
  message.header.info.encoding = Encoding::Zstd;
  EXPECT_FALSE(as_mat(message));
}

}  // namespace
}  // namespace hc
