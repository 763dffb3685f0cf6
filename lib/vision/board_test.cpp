// SPDX-License-Identifier: Apache-2.0
#include <vision/board.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <hc/testing/must.h>
#include <vision/drawn_board_test.h>

namespace hc::vision {
namespace {

const cv::Size kDrawnSize(640, 480);
const cv::Matx33d kDrawnCamera(600, 0, 319.5, 0, 600, 239.5, 0, 0, 1);
const std::vector<double> kDrawnLens = {-0.2, 0.05, 0.001, -0.0005, 0};

const DrawingCamera& drawing_camera() {
  static const DrawingCamera drawing(kDrawnCamera, kDrawnLens, kDrawnSize);
  return drawing;
}

/// The largest distance of the corners found from those drawn [px].
double worst_corner(const cv::Vec3d& tilt) {
  const auto pose = BoardPose::at(kTestBoard, tilt, {0, 0, 0.4});
  const cv::Mat image = drawing_camera().draw(printed(kTestBoard), pose);
  const auto view = must(find_board(image, image, kTestBoard));
  const auto truth = corners_of(kTestBoard, pose, kDrawnCamera, kDrawnLens);
  double worst = 0, worst_reversed = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    worst = std::max(worst, cv::norm(view.left[i] - truth[i]));
    worst_reversed = std::max(worst_reversed, cv::norm(view.left[truth.size() - 1 - i] - truth[i]));
  }
  return std::min(worst, worst_reversed);
}

TEST(Board, TheSameCornerHasTheSamePlaceInBothImages) {
  cv::Mat image(480, 640, CV_8U, cv::Scalar(255));
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 10; ++column)
      if ((row + column) % 2 == 0)
        cv::rectangle(image, cv::Rect(60 + 50 * column, 60 + 50 * row, 50, 50), 0, cv::FILLED);
  auto view = must(find_board(image, image, kTestBoard));
  EXPECT_LT(cv::norm(view.left[3] - view.right[3]), 1e-3);
  EXPECT_NEAR(cv::norm(view.left.front() - view.left.back()), std::hypot(400, 250), 0.1);
  BoardView moved = view;
  for (auto& corner : moved.left) corner.x += 10;
  EXPECT_NEAR(difference(view, moved), 5, 1e-3) << "px: the mean of both eyes";
  BoardView first_two{{view.left[0], view.left[1]}, {view.right[0], view.right[1]}, {0, 1}};
  EXPECT_NEAR(difference(first_two, moved), 5, 1e-3) << "px: of the corners in common";
  BoardView third{{view.left[2]}, {view.right[2]}, {2}};
  EXPECT_TRUE(std::isinf(difference(first_two, third))) << "no corner in common";
  EXPECT_FALSE(find_board(cv::Mat::zeros(480, 640, CV_8U), image, kTestBoard));
  EXPECT_FALSE(find_board(cv::Mat(), cv::Mat(), kTestBoard));
  for (const int side : {1, 2, 7, 30}) {
    const cv::Mat tiny(side, side, CV_8U, cv::Scalar(100));
    EXPECT_FALSE(find_board(tiny, tiny, kTestBoard)) << side;
  }
}

TEST(Board, TiltedCornersAreWhereTheyWereDrawn) {
  double worst = 0;
  for (const cv::Vec3d& tilt :
       {cv::Vec3d(0, 0, 0), cv::Vec3d(1.1, 0, 0), cv::Vec3d(-1.0, 0.1, 0.1), cv::Vec3d(0, 1.1, 0),
        cv::Vec3d(0.1, -1.0, -0.2), cv::Vec3d(0.6, 0.6, 0.4)}) {
    const double off = worst_corner(tilt);
    EXPECT_LT(off, 0.4) << "px, tilted by " << tilt;
    worst = std::max(worst, off);
  }
  std::printf("[          ] worst corner %.2f px\n", worst);
}

// Processor time, on which other processes have no influence; a search once took 8 to 34 s.
TEST(Board, AWrongOrIncompleteBoardIsNotSearchedForLong) {
  cv::Mat image = drawing_camera().draw(printed(kTestBoard),
                                        BoardPose::at(kTestBoard, {0.3, -0.2, 0.1}, {0, 0, 0.5}));
  ASSERT_TRUE(find_board(image, image, kTestBoard));
  const std::clock_t begin = std::clock();
  for (const Board& wrong :
       {Board{8, 6}, Board{9, 7}, Board{10, 7}, Board{7, 5}, Board{5, 4}, Board{20, 15}})
    EXPECT_FALSE(find_board(image, image, wrong)) << wrong.columns << " x " << wrong.rows;
  for (const int hidden : {200, 260, 320}) {
    image.colRange(0, hidden).setTo(110);
    EXPECT_FALSE(find_board(image, image, kTestBoard)) << hidden;
  }
  constexpr int kSearches = 9;
  EXPECT_LT((std::clock() - begin) / kSearches, 2 * CLOCKS_PER_SEC);
}

}  // namespace
}  // namespace hc::vision
