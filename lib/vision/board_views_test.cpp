// SPDX-License-Identifier: Apache-2.0
#include <vision/board_views.h>

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

constexpr Board kPrinted{9, 6, 0.025};

/// A board with its top left square there.
cv::Mat board_at(cv::Point at, cv::Size size = {640, 480}) {
  cv::Mat image(size, CV_8U, cv::Scalar(255));
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 10; ++column)
      if ((row + column) % 2 == 0)
        cv::rectangle(image, cv::Rect(at.x + 40 * column, at.y + 40 * row, 40, 40), 0, cv::FILLED);
  return image;
}

BoardViews make() {
  auto views = BoardViews::make(kPrinted);
  EXPECT_TRUE(views);
  return std::move(*views);
}

TEST(BoardViews, takes_those_that_differ_from_all_others) {
  auto views = make();
  const auto is_taken = [&](int x, double min_difference) {
    return *views.take(board_at({x, 60}), board_at({x, 60}), min_difference);
  };
  EXPECT_TRUE(is_taken(60, 0.02));
  EXPECT_FALSE(is_taken(60, 0.02));
  EXPECT_TRUE(is_taken(90, 0.02));
  EXPECT_FALSE(is_taken(66, 0.02)) << "6 px from the first, of 640";
  EXPECT_TRUE(is_taken(66, 0.005));
  EXPECT_EQ(views.size(), 3U);
}

TEST(BoardViews, takes_none_without_a_board) {
  auto views = make();
  const cv::Mat board = board_at({60, 60}), empty(480, 640, CV_8U, cv::Scalar(255));
  EXPECT_FALSE(*views.take(board, empty, 0));
  EXPECT_FALSE(*views.take(empty, board, 0));
  EXPECT_EQ(views.size(), 0U);
}

TEST(BoardViews, images_are_of_one_size) {
  auto views = make();
  const cv::Mat board = board_at({60, 60}), large = board_at({60, 60}, {800, 600});
  EXPECT_EQ(views.take(board, large, 0).error().code, Code::Unsupported);
  EXPECT_TRUE(*views.take(board, board, 0));
  EXPECT_EQ(views.take(large, large, 0).error().code, Code::Unsupported);
}

TEST(BoardViews, a_board_has_more_corners_in_a_row_than_in_a_column_or_fewer) {
  EXPECT_EQ(BoardViews::make({6, 6, 0.025}).error().code, Code::Invalid);
}

TEST(BoardViews, too_few_do_not_calibrate) {
  EXPECT_EQ(make().calibrate().error().code, Code::NotFound);
}

}  // namespace
}  // namespace hc::vision
