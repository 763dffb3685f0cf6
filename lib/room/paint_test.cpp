// SPDX-License-Identifier: Apache-2.0
#include <room/paint.h>

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::room {

namespace {

TEST(Paint, a_tag_is_found_by_its_detector) {
  // cv::Ptr in OpenCV 4.6, a value in 4.7 and later.
  const auto dictionary = [](const auto& each) -> cv::Ptr<cv::aruco::Dictionary> {
    if constexpr (requires { each.get(); })
      return each;
    else
      return cv::makePtr<cv::aruco::Dictionary>(each);
  }(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250));
  for (const auto& [name, id] : {std::pair("aruco", 23), std::pair("aruco", 40)}) {
    cv::Mat image, around(400, 400, CV_8UC3, cv::Scalar::all(255));
    cv::resize(paint_tag(name, id), image, {200, 200}, 0, 0, cv::INTER_NEAREST);
    image.copyTo(around(cv::Rect(100, 100, 200, 200)));
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(around, dictionary, corners, ids);
    ASSERT_EQ(ids, std::vector<int>{id});
    EXPECT_NEAR(corners[0][0].x, 120, 1);  // a margin of one cell of ten
    EXPECT_NEAR(corners[0][0].y, 120, 1);
  }
}

TEST(Paint, a_board_has_its_letters_within_and_others_for_another_text) {
  const cv::Mat one = paint_board("HELLO", 400, 100), other = paint_board("HULLO", 400, 100);
  EXPECT_GT(cv::norm(one, other, cv::NORM_L1), 0);
  EXPECT_EQ(cv::norm(one.col(5), one.col(399), cv::NORM_INF), 0);  // the margin
  EXPECT_LT(cv::mean(one)[0], 235);
  EXPECT_GT(cv::mean(paint_board("", 400, 100))[0], 240);
}

TEST(Paint, a_board_has_letters_that_are_not_ascii) {
  const cv::Mat board = paint_board("Gr\u00fc\u00dfe", 400, 100);
  for (const char* other : {"Grusse", "Gr\u00fcse", "Gr??e", "Gr????e", "Gr\u00fc\u00e4e"})
    EXPECT_GT(cv::norm(board, paint_board(other, 400, 100), cv::NORM_L1), 0) << other;
  EXPECT_EQ(cv::norm(board.col(5), board.col(399), cv::NORM_INF), 0);  // the margin
  EXPECT_LT(cv::mean(board)[0], 235);
}

TEST(Paint, the_same_seed_gives_the_same_bytes) {
  EXPECT_EQ(cv::norm(paint_poster(64, 48, 3), paint_poster(64, 48, 3), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(paint_poster(64, 48, 3), paint_poster(64, 48, 4), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(paint_planks(64, 48, 3), paint_planks(64, 48, 3), cv::NORM_INF), 0);
}

}  // namespace

}  // namespace hc::room
