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

BoardViews make(std::size_t most = 20) {
  auto views = BoardViews::make(kPrinted, most);
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
  EXPECT_EQ(BoardViews::make({6, 6, 0.025}, 20).error().code, Code::Invalid);
}

TEST(BoardViews, too_few_do_not_calibrate) {
  EXPECT_EQ(make().calibrate().error().code, Code::NotFound);
  auto views = make();
  EXPECT_TRUE(*views.take(board_at({60, 60}), board_at({60, 60}), 0));
  const cv::Mat empty(480, 640, CV_8U, cv::Scalar(255));
  EXPECT_FALSE(*views.take(empty, empty, 0));
  EXPECT_EQ(views.calibrate().error().detail,
            "1 views of the board, at least 3 are needed; "
            "the board of 9 x 6 inner corners was found in 1 of 2 pairs");
}

TEST(BoardViews, when_full_one_of_the_most_similar_is_replaced) {
  auto views = make(3);
  const auto has = [&](int x) { return !*views.take(board_at({x, 60}), board_at({x, 60}), 0.005); };
  for (const int x : {60, 100, 140, 144}) EXPECT_FALSE(has(x)) << x;
  EXPECT_EQ(views.size(), 3U);
  EXPECT_TRUE(has(60) && has(100) && has(144));
  EXPECT_FALSE(has(140));
}

TEST(BoardViews, boards_that_face_the_cameras_are_to_be_tilted) {
  auto views = make();
  for (const int x : {60, 90, 120, 150, 180})
    for (const int y : {60, 100, 140}) {
      // Nearer to the right camera.
      EXPECT_TRUE(*views.take(board_at({x, y}), board_at({x - 40, y}), 0.02));
    }
  const auto calibrated = views.calibrate();
  ASSERT_FALSE(calibrated);
  EXPECT_TRUE(calibrated.error().detail.ends_with(
      "; tilt the board to the left (the left edge in the image farther away)"))
      << calibrated.error().detail;
}

TEST(BoardViews, the_picture_shows_where_boards_were) {
  auto views = make();
  const cv::Mat first = board_at({60, 60}), second = board_at({180, 160});
  EXPECT_TRUE(*views.take(first, first, 0.02));
  EXPECT_TRUE(*views.take(second, second, 0.02));
  const cv::Mat picture = views.picture(second);
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(picture.size(), second.size());
  const auto is_green = [&](int x, int y) {
    const auto pixel = picture.at<cv::Vec3b>(y, x);
    return pixel[1] > pixel[0] + 20;
  };
  EXPECT_TRUE(is_green(120, 120)) << "of the first view";
  EXPECT_TRUE(is_green(510, 370)) << "of the second one";
  EXPECT_FALSE(is_green(620, 460));
}

}  // namespace
}  // namespace hc::vision
