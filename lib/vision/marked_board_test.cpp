// SPDX-License-Identifier: Apache-2.0
#include <vision/marked_board.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>

#include <opencv2/imgproc.hpp>

#include <hc/testing/must.h>
#include <vision/drawn_board_test.h>
#include <vision/marker_finder.h>
#include <vision/opencv_charuco_test.h>

namespace hc::vision {
namespace {

constexpr const char* kDictionary = "6X6_250";
constexpr Board kCharuco{11, 8, 0.025, BoardKind::Charuco, 0.018};
constexpr Board kOddCharuco{8, 11, 0.025, BoardKind::Charuco, 0.018};
constexpr Board kGrid{6, 5, 0, BoardKind::AprilGrid, 0.035, 0.3};

const cv::Size kSeen(800, 600);
const cv::Matx33d kEye(600, 0, 399.5, 0, 600, 299.5, 0, 0, 1);
const std::vector<double> kLens = {-0.2, 0.05, 0.001, -0.0005, 0};

MarkedBoardFinder finder_of(const Board& board, const std::string& dictionary = kDictionary) {
  return must(MarkedBoardFinder::make(board, dictionary));
}

cv::Mat drawn(const Print& print, const BoardPose& pose) {
  static const DrawingCamera camera(kEye, kLens, kSeen);
  return camera.draw(print, pose);
}

cv::Mat drawn(const Board& board, const cv::Vec3d& tilt = {0.3, -0.2, 0.1}) {
  return drawn(printed(board, kDictionary), BoardPose::at(board, tilt, {0, 0, 0.4}));
}

/// The largest distance of the corners found from those drawn [px].
double worst_of(const BoardView& view, const Board& board, const BoardPose& pose) {
  const auto truth = corners_of(board, pose, kEye, kLens);
  double worst = 0;
  for (std::size_t i = 0; i < view.left.size(); ++i)
    worst = std::max({worst, cv::norm(view.left[i] - truth[view.number(i)]),
                      cv::norm(view.right[i] - truth[view.number(i)])});
  return worst;
}

class EachMarkedBoard : public ::testing::TestWithParam<Board> {};

TEST_P(EachMarkedBoard, tilted_corners_are_where_they_were_drawn) {
  const auto finder = finder_of(GetParam());
  for (const cv::Vec3d& tilt :
       {cv::Vec3d(0, 0, 0), cv::Vec3d(1.0, 0, 0), cv::Vec3d(-1.0, 0.1, 0.1), cv::Vec3d(0, 1.0, 0),
        cv::Vec3d(0.1, -1.0, -0.2), cv::Vec3d(0.6, 0.6, 0.4), cv::Vec3d(0, 0, 2.5)}) {
    const auto pose = BoardPose::at(GetParam(), tilt, {0, 0, 0.4});
    const cv::Mat image = drawn(printed(GetParam(), kDictionary), pose);
    const auto view = finder.find(image, image);
    ASSERT_TRUE(view) << tilt;
    const double worst = worst_of(*view, GetParam(), pose);
    std::printf("[          ] %zu of %zu corners, worst %.2f px\n", view->left.size(),
                GetParam().corners().size(), worst);
    EXPECT_LT(worst, 0.5) << "px, tilted by " << tilt;
    EXPECT_GT(view->left.size(), 0.5 * static_cast<double>(GetParam().corners().size())) << tilt;
    EXPECT_TRUE(std::is_sorted(view->numbers.begin(), view->numbers.end()));
  }
}

TEST_P(EachMarkedBoard, a_part_is_enough_if_both_eyes_see_it) {
  const auto pose = BoardPose::at(GetParam(), {0.3, -0.2, 0.1}, {0, 0, 0.4});
  const cv::Mat whole = drawn(printed(GetParam(), kDictionary), pose);
  cv::Mat right_half = whole.clone(), left_half = whole.clone();
  right_half.colRange(0, 420).setTo(110);
  left_half.colRange(420, whole.cols).setTo(110);
  const auto finder = finder_of(GetParam());
  const auto view = must(finder.find(whole, right_half));
  EXPECT_LT(view.left.size(), 0.7 * static_cast<double>(GetParam().corners().size()));
  EXPECT_LT(worst_of(view, GetParam(), pose), 0.5) << "px";
  EXPECT_FALSE(finder.find(left_half, right_half)) << "they see no corner in common";
}

TEST_P(EachMarkedBoard, what_is_outside_the_image_is_not_needed) {
  const auto pose = BoardPose::at(GetParam(), {0.2, 0.3, 0}, {0.14, 0.09, 0.35});
  const cv::Mat image = drawn(printed(GetParam(), kDictionary), pose);
  const auto view = must(finder_of(GetParam()).find(image, image));
  EXPECT_LT(view.left.size(), GetParam().corners().size());
  EXPECT_LT(worst_of(view, GetParam(), pose), 0.5) << "px";
}

TEST_P(EachMarkedBoard, is_not_found_where_it_is_not) {
  const auto finder = finder_of(GetParam());
  const cv::Mat board = drawn(GetParam()), empty(kSeen, CV_8U, cv::Scalar(110));
  cv::Mat mirrored, noise(kSeen, CV_8U);
  cv::flip(board, mirrored, 1);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  ASSERT_TRUE(finder.find(board, board));
  EXPECT_FALSE(finder.find(board, empty)) << "seen by the left eye only";
  EXPECT_FALSE(finder.find(empty, board)) << "seen by the right eye only";
  EXPECT_FALSE(finder.find(mirrored, mirrored));
  EXPECT_FALSE(finder.find(noise, noise));
  EXPECT_FALSE(finder.find(cv::Mat(), cv::Mat()));
  const cv::Mat chessboard = drawn(kTestBoard);
  EXPECT_FALSE(finder.find(chessboard, chessboard));
  for (int more : {-2, -1, 1, 2}) {
    Board wrong = GetParam();
    wrong.columns += more;
    EXPECT_FALSE(finder_of(wrong).find(board, board)) << wrong.text();
  }
  const cv::Mat large(1944, 2592, CV_8U, cv::Scalar(110));
  EXPECT_FALSE(finder.find(large, large));
}

INSTANTIATE_TEST_SUITE_P(MarkedBoard, EachMarkedBoard,
                         testing::Values(kCharuco, kOddCharuco, kGrid), [](const auto& instance) {
                           return std::string(
                               instance.param.kind == BoardKind::AprilGrid ? "AprilGrid"
                               : instance.param.rows % 2 == 0              ? "Charuco"
                                                                           : "CharucoWithOddRows");
                         });

TEST(MarkedBoard, another_dictionary_is_another_board) {
  const cv::Mat image = drawn(kCharuco);
  EXPECT_FALSE(finder_of(kCharuco, "5X5_250").find(image, image));
  EXPECT_FALSE(finder_of(kGrid).find(image, image));
  EXPECT_EQ(refused(MarkedBoardFinder::make(kCharuco, "9X9_9")).code, Code::Invalid);
  const Board large{12, 9, 0.025, BoardKind::Charuco, 0.018};
  EXPECT_EQ(refused(MarkedBoardFinder::make(large, "4X4_50")).detail,
            "the dictionary has 50 markers, the board 54");
}

TEST(MarkedBoard, markers_of_another_board_are_ignored) {
  const auto pose = BoardPose::at(kCharuco, {0.3, -0.2, 0.1}, {0.05, 0, 0.5});
  cv::Mat image = drawn(printed(kCharuco, kDictionary), pose);
  const Board small{3, 4, 0.025, BoardKind::Charuco, 0.018};
  const cv::Mat other =
      drawn(printed(small, kDictionary), BoardPose::at(small, {}, {-0.26, 0.05, 0.5}));
  const cv::Rect corner(0, 220, 190, 300);
  other(corner).copyTo(image(corner));
  const auto view = must(finder_of(kCharuco).find(image, image));
  EXPECT_LT(worst_of(view, kCharuco, pose), 0.5) << "px";
}

TEST(MarkedBoard, is_printed_as_opencv_draws_it) {
  for (const Board& board : {kCharuco, kOddCharuco}) {
    const double dot = board.square / 100;
    const cv::Mat ours = image_of(must(print_of(board, kDictionary)), dot);
    const cv::Rect squares(100, 100, 100 * board.columns, 100 * board.rows);
    const cv::Mat theirs = drawn_by_opencv(board, squares.size());
    EXPECT_LT(cv::countNonZero(ours(squares) != theirs), 0.001 * squares.area()) << board.text();
  }
}

// Kalibr prints the bits of a code row by row, the highest first; 0 is black.
TEST(MarkedBoard, tags_are_printed_as_kalibr_prints_them) {
  for (const auto& [id, code] : {std::pair(0, 0xd5d628584), {1, 0xd97f18b49}, {586, 0xe83be4b73}}) {
    std::int64_t read = 0;
    const cv::Mat cells = apriltag_cells(id);
    for (int i = 0; i < 36; ++i) read = 2 * read + (cells.at<std::uint8_t>(i / 6, i % 6) != 0);
    EXPECT_EQ(read, code) << id;
  }
}

TEST(MarkedBoard, may_be_as_opencv_drew_it_before_4_6) {
  const auto layout = layout_of(kCharuco, true);
  const auto markers = must(ArucoFinder::make(kDictionary));
  BoardPrint print{{0.025 * 13, 0.025 * 10}, {0.05, 0.05}, {}};
  for (int row = 0; row < 8; ++row)
    for (int column = 1 - row % 2; column < 11; column += 2)
      print.areas.push_back({{0.025 * (column + 1), 0.025 * (row + 1), 0.025, 0.025}});
  Print picture{image_of(print, 0.025 / 64, 20, 230), 0.025 / 64, print.origin};
  for (std::size_t id = 0; id < layout.size(); ++id) {
    const cv::Point2d at = (print.origin + cv::Point2d(layout[id].corners[0])) / picture.dot;
    cv::Mat cells, marker;
    cv::copyMakeBorder(markers.cells(static_cast<int>(id)), cells, 1, 1, 1, 1, cv::BORDER_CONSTANT,
                       cv::Scalar(0));
    const int side = static_cast<int>(std::lround(0.018 / picture.dot));
    cv::resize(cells, marker, {side, side}, 0, 0, cv::INTER_NEAREST);
    marker.copyTo(picture.picture(cv::Rect(cv::Point(at), marker.size())));
  }
  const auto pose = BoardPose::at(kCharuco, {0.3, -0.2, 0.1}, {0, 0, 0.4});
  const cv::Mat image = drawn(picture, pose);
  const auto view = must(finder_of(kCharuco).find(image, image));
  EXPECT_EQ(view.left.size(), 70U);
  EXPECT_LT(worst_of(view, kCharuco, pose), 0.5) << "px";
}

// Processor time, on which other processes have no influence.
TEST(MarkedBoard, is_not_searched_for_long) {
  cv::Mat noise(kSeen, CV_8U), large(1944, 2592, CV_8U);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::resize(drawn(kGrid), large, large.size());
  for (const Board& board : {kCharuco, kGrid}) {
    const auto finder = finder_of(board);
    for (const cv::Mat& image : {drawn(kCharuco), drawn(kGrid), drawn(kTestBoard), noise, large}) {
      const std::clock_t begin = std::clock();
      static_cast<void>(finder.find(image, image));
      const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      std::printf("[          ] %s, %d px wide: %.3f s\n", board.text().c_str(), image.cols,
                  seconds);
      EXPECT_LT(seconds, 2) << board.text();
    }
  }
}

TEST(MarkedBoard, a_board_that_cannot_be_is_refused) {
  const auto detail = [](const Board& board) {
    return refused(MarkedBoardFinder::make(board, kDictionary)).detail;
  };
  EXPECT_EQ(detail({11, 8, 0.025, BoardKind::Charuco}),
            "marker_size is missing: the side of a marker");
  EXPECT_EQ(detail({11, 8, 0.025, BoardKind::Charuco, 0.025}), "marker_size is not below square");
  EXPECT_EQ(detail({2, 8, 0.025, BoardKind::Charuco, 0.02}), "columns and rows: at least 3 each");
  EXPECT_EQ(detail({6, 6, 0, BoardKind::AprilGrid}), "marker_size is missing: the side of a tag");
  EXPECT_EQ(detail({40, 40, 0, BoardKind::AprilGrid, 0.03, 0.3}),
            "columns and rows: 36h11 has 587 tags");
  EXPECT_EQ(detail({9, 6, 0.025}), "a board without markers");
}

TEST(BoardPrint, a_page_is_as_large_as_its_board) {
  const auto print = must(print_of(kCharuco, kDictionary));
  EXPECT_NEAR(print.paper.width, 13 * 0.025, 1e-9);
  const std::string pdf = pdf_of(print);
  EXPECT_TRUE(pdf.starts_with("%PDF-"));
  EXPECT_NE(pdf.find("/MediaBox [0 0 921.2598 708.6614]"), std::string::npos) << "1/72 inch";
  EXPECT_EQ(pdf.find("xref\n"), std::stoul(pdf.substr(pdf.find("startxref\n") + 10)));
}

}  // namespace
}  // namespace hc::vision
