// SPDX-License-Identifier: Apache-2.0
#include "recogniser.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace {

cv::Mat written(const std::string& text) {
  cv::Mat line(76, 40 * static_cast<int>(text.size()) + 60, CV_8U, cv::Scalar(255));
  cv::putText(line, text, {20, 58}, cv::FONT_HERSHEY_DUPLEX, 1.8, cv::Scalar(0), 4, cv::LINE_AA);
  return line;
}

TEST(Recogniser, reads_a_clean_line) {
  auto recogniser = Recogniser::make("eng", true);
  ASSERT_TRUE(recogniser) << recogniser.error().text();
  const auto reading = recogniser->read(written("ROBOT HEAD 27"));
  EXPECT_EQ(reading.text, "ROBOT HEAD 27");
  EXPECT_GT(reading.confidence, 0.6);
  EXPECT_EQ(recogniser->read(written("SECOND")).text, "SECOND");
}

TEST(Recogniser, gives_no_text_for_an_empty_line) {
  auto recogniser = Recogniser::make("eng", true);
  ASSERT_TRUE(recogniser) << recogniser.error().text();
  EXPECT_EQ(recogniser->read(cv::Mat(76, 300, CV_8U, cv::Scalar(255))).text, "");
}

TEST(Recogniser, says_which_language_is_missing) {
  auto recogniser = Recogniser::make("no_such", true);
  ASSERT_FALSE(recogniser);
  EXPECT_EQ(recogniser.error().code, hc::Code::Invalid);
  EXPECT_NE(recogniser.error().detail.find("no_such"), std::string::npos);
}

}  // namespace
