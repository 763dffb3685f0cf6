// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace {

cv::Mat written(const std::string& text, int font, int stroke, double blur) {
  cv::Mat line(80, 42 * static_cast<int>(text.size()) + 60, CV_8U, cv::Scalar(255));
  cv::putText(line, text, {20, 60}, font, 1.9, cv::Scalar(0), stroke, cv::LINE_AA);
  if (blur > 0) cv::GaussianBlur(line, line, {}, blur);
  return line;
}

TEST(Shapes, tell_what_looks_alike_apart) {
  const std::string text = "0OQ 1I 2Z 5S 8B", wrong = "OQ0 I1 Z2 S5 B8";
  for (int font : {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX})
    for (int stroke : {5, 6})
      for (double blur : {0.0, 1.0, 1.5}) {
        const cv::Mat line = written(text, font, stroke, blur);
        EXPECT_EQ(by_shape(line, text), text) << font << " " << stroke << " " << blur;
        EXPECT_EQ(by_shape(line, wrong), text) << font << " " << stroke << " " << blur;
      }
}

TEST(Shapes, tell_round_ones_by_their_sides) {
  const std::string text = "35S9680BO 4A 6E VY";
  for (int font : {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX})
    for (int stroke : {5, 6})
      for (double blur : {0.0, 1.0, 1.5}) {
        const cv::Mat line = written(text, font, stroke, blur);
        for (const std::string wrong : {"5SSSEBOSO A4 EE YV", "SS9O830BO A4 66 VV"})
          EXPECT_EQ(by_shape(line, wrong), text) << font << " " << stroke << " " << blur;
      }
}

TEST(Shapes, a_stroke_without_a_gap_is_no_exclamation_mark) {
  const cv::Mat line = written("I1!", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, "!!!"), "I1!");
}

TEST(Shapes, which_of_two_is_left_fits_the_others) {
  const cv::Mat line = written("56X6N", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, "56X6EN"), "56X6N");
  EXPECT_EQ(by_shape(line, "S56X6N"), "56X6N");
}

TEST(Shapes, of_both_for_one_letter_one_is_left) {
  const cv::Mat line = written("A5 0K", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, "AS5 O0K"), "A5 0K");
  EXPECT_EQ(by_shape(line, "A5S 0OK"), "A5 0K");
}

TEST(Shapes, take_out_a_space_where_none_is) {
  const cv::Mat line = written("8F1C B", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, "8F 1C B"), "8F1C B");
}

TEST(Shapes, leave_other_letters_as_they_are) {
  const std::string text = "ACDEFGHJKLMNPQRTUVWXY34679";
  EXPECT_EQ(by_shape(written(text, cv::FONT_HERSHEY_DUPLEX, 5, 1), text), text);
}

TEST(Shapes, do_nothing_where_letters_cannot_be_counted) {
  const cv::Mat line = written("50", cv::FONT_HERSHEY_DUPLEX, 5, 0);
  EXPECT_EQ(by_shape(line, "SOO"), "SOO");
  EXPECT_EQ(by_shape(cv::Mat(80, 100, CV_8U, cv::Scalar(255)), "SO"), "SO");
  EXPECT_EQ(by_shape(cv::Mat(80, 100, CV_8U, cv::Scalar(255)), ""), "");
}

TEST(Shapes, what_stands_one_above_the_other_is_one_letter) {
  EXPECT_EQ(find_letters(written("A!?", cv::FONT_HERSHEY_DUPLEX, 4, 0)).size(), 3U);
}

TEST(Shapes, letters_that_touch_are_parted) {
  // Two pieces, of which the second is moved until it touches the first.
  cv::Mat line = written("LAV56X", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  const auto apart = find_letters(line);
  ASSERT_EQ(apart.size(), 6U);
  const int gap = apart[1].x - apart[0].br().x;
  cv::Mat touching(line.size(), CV_8U, cv::Scalar(255));
  const int at = apart[1].x - gap / 2;
  line.colRange(0, at).copyTo(touching.colRange(0, at));
  cv::Mat rest = touching.colRange(at - gap - 1, line.cols - gap - 1);
  cv::min(rest, line.colRange(at, line.cols), rest);
  ASSERT_EQ(find_letters(touching).size(), 6U);
  EXPECT_EQ(by_shape(touching, "LAVS6X"), "LAV56X");
}

TEST(Shapes, a_dash_is_one_letter) {
  EXPECT_EQ(find_letters(written("A-B", cv::FONT_HERSHEY_DUPLEX, 5, 0)).size(), 3U);
}

}  // namespace
