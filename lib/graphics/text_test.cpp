// SPDX-License-Identifier: Apache-2.0
#include <graphics/text.h>

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace hc::graphics {
namespace {

cv::Mat written(const std::string& text) {
  const auto pen = pen_for(text, cv::Scalar::all(255));
  int below = 0;
  const auto size = pen.measure(text, 2, 3, below);
  cv::Mat image = cv::Mat::zeros(120, std::max(size.width, 0) + 40, CV_8UC3), grey;
  pen.write(image, text, {20, 80}, 2, 3);
  cv::cvtColor(image, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

TEST(Text, capitals_are_22_px_high_in_both_fonts) {
  for (const char* text : {"H", "\u0397"}) {  // in ASCII, and the Greek Eta
    const auto box = cv::boundingRect(written(text) > 127);
    EXPECT_NEAR(box.height, 2 * 22, 4) << text;
    EXPECT_NEAR(box.br().y, 80, 3) << text;
    EXPECT_GE(box.x, 18) << text;
  }
}

TEST(Text, strange_letters_and_none_are_no_error) {
  for (const char* text : {"", " ", "\t", "\u4f60\u597d", "\U0001f600", "e\u0301\u0301\u0301\u0301",
                           "\u05d0\u0628", "\xff\xfe", "\xe2\x82", "\u200d", "\u0378"})
    EXPECT_NO_THROW(written(text)) << text;
  EXPECT_GT(cv::countNonZero(written("\xc3")), 0) << "its beginning only";
}

}  // namespace
}  // namespace hc::graphics
