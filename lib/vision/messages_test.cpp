// SPDX-License-Identifier: Apache-2.0
#include <vision/messages.h>

#include <gtest/gtest.h>

#include <array>

namespace hc {
namespace {

DraftOf<RgbImageKind<std::uint8_t>> image(std::int32_t width, std::int32_t height) {
  return {Draft::make(rgb_image().type.info, height, width)};
}

TEST(OpenCv, SharesElementsBothWays) {
  auto draft = image(4, 2);
  cv::Mat made = as_mat(draft);
  made.setTo(cv::Scalar(1, 2, 3));
  made.at<cv::Vec3b>(1, 3) = {7, 8, 9};
  MessageOf<RgbImageKind<std::uint8_t>> message{std::move(draft).finish()};
  cv::Mat seen = as_mat(message);
  EXPECT_EQ(static_cast<const void*>(seen.data), message.elements.data());
  EXPECT_EQ(seen.rows, 2);
  EXPECT_EQ(seen.cols, 4);
  EXPECT_EQ(seen.at<cv::Vec3b>(1, 3), cv::Vec3b(7, 8, 9));
  EXPECT_EQ(message.matrix().at(1, 3, 2), 9);
}

TEST(OpenCv, WhatIsWrittenInPlaceIsNotCopied) {
  auto draft = image(4, 2);
  const auto* own = as_mat(draft).data;
  fill(draft, [&](cv::Mat& mat) {
    mat.setTo(cv::Scalar(1, 2, 3));
    EXPECT_EQ(mat.data, own);
  });
  EXPECT_EQ(draft.matrix().at(1, 3, 2), 3);
}

TEST(OpenCv, WhatWasAllocatedAnewIsCopiedIntoTheDraft) {
  auto draft = image(4, 2);
  fill(draft, [](cv::Mat& mat) { mat = cv::Mat(2, 4, CV_8UC3, cv::Scalar(4, 5, 6)); });
  EXPECT_EQ(draft.matrix().at(1, 3, 2), 6);
}

TEST(OpenCv, AResultOfAnotherShapeOrTypeIsABug) {
  auto draft = image(4, 2);
  EXPECT_DEATH(fill(draft, [](cv::Mat& mat) { mat = cv::Mat(2, 4, CV_8UC1); }), "check failed");
  EXPECT_DEATH(fill(draft, cv::Mat(4, 2, CV_8UC3)), "check failed");
}

TEST(OpenCv, HasTheDepthOfEachScalarThatItKnows) {
  const std::pair<Scalar, int> depths[] = {
      {Scalar::U8, CV_8U},   {Scalar::I8, CV_8S},   {Scalar::U16, CV_16U}, {Scalar::I16, CV_16S},
      {Scalar::I32, CV_32S}, {Scalar::F32, CV_32F}, {Scalar::F64, CV_64F}};
  for (const auto& [scalar, depth] : depths) EXPECT_EQ(*cv_depth(scalar), depth);
  for (Scalar scalar : {Scalar::U32, Scalar::U64, Scalar::I64})
    EXPECT_EQ(cv_depth(scalar).error().code, Code::Unsupported);
  EXPECT_FALSE(as_mat(Message(table<std::uint32_t>().message({1}))));
}

TEST(OpenCv, CompressedIsRefused) {
  Message message = table().message({1.0});
  message.header.info.encoding = Encoding::Zstd;
  EXPECT_FALSE(as_mat(message));
}

}  // namespace
}  // namespace hc
