// SPDX-License-Identifier: Apache-2.0
#include <vision/letters.h>

#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

/// A grey room with a dark-framed white board, (H, W, 3) u8.
cv::Mat scene(const std::string& text, cv::Point at = {300, 200}, double scale = 1.0) {
  cv::Mat image(600, 800, CV_8UC3, cv::Scalar(150, 155, 150));
  int below = 0;
  const int stroke = scale > 1 ? 3 : 2;
  const auto size = cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, scale, stroke, &below);
  const int h = size.height;
  const cv::Rect board(at.x - h, at.y - 2 * h, size.width + 2 * h, 3 * h);
  cv::rectangle(image, board, {240, 240, 235}, cv::FILLED);
  cv::rectangle(image, board, {70, 75, 80}, 3);
  cv::putText(image, text, at, cv::FONT_HERSHEY_DUPLEX, scale, {20, 20, 25}, stroke, cv::LINE_AA);
  // A wall with a dark pipe, a striped box and a checkered board.
  cv::rectangle(image, {60, 0, 14, 600}, {60, 60, 60}, cv::FILLED);
  for (int i = 0; i < 9; ++i)
    cv::rectangle(image, {560 + 14 * i, 430, 12, 40}, {90.0 + 9 * (i % 4), 80, 70}, cv::FILLED);
  for (int i = 0; i < 16; i += 2)
    cv::rectangle(image, {150 + 15 * (i % 4) + 15 * (i / 4 % 2), 450 + 15 * (i / 4), 15, 15},
                  {10, 10, 10}, cv::FILLED);
  return image;
}

void add_grain(cv::Mat& image, double deviation, int seed) {
  cv::Mat noise(image.size(), CV_16SC3), sum;
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(noise, cv::RNG::NORMAL, 0, deviation);
  cv::add(image, noise, sum, cv::noArray(), CV_8U);
  image = sum;
}

cv::Rect text_box(const std::string& text, cv::Point at = {300, 200}, double scale = 1.0) {
  int below = 0;
  const auto size =
      cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, scale, scale > 1 ? 3 : 2, &below);
  return {at.x, at.y - size.height, size.width, size.height};
}

/// The best line found.
TextLine best_line(const cv::Mat& image) {
  const auto lines = find_text_lines(image);
  EXPECT_FALSE(lines.empty());
  return lines.empty() ? TextLine() : lines[0];
}

TEST(Letters, finds_the_line_on_the_board) {
  const auto line = best_line(scene("HELLO ROBOT"));
  const auto box = text_box("HELLO ROBOT");
  EXPECT_NEAR(line.middle().x, box.x + box.width / 2.0, 3);
  EXPECT_NEAR(line.middle().y, box.y + box.height / 2.0, 2);
  EXPECT_NEAR(line.width(), box.width, 6);
  EXPECT_NEAR(line.height, box.height, 2);
  EXPECT_GE(line.letters, 8);  // some touch
  EXPECT_TRUE(line.is_whole);
}

TEST(Letters, finds_it_in_noise_and_in_the_dark) {
  for (int seed = 0; seed < 5; ++seed) {
    cv::Mat image = scene("WATER 27");
    image = 0.6 * image;
    add_grain(image, 20, seed);
    const auto line = best_line(image);
    const auto box = text_box("WATER 27");
    EXPECT_NEAR(line.middle().x, box.x + box.width / 2.0, 5);
    EXPECT_NEAR(line.width(), box.width, 10);
  }
}

TEST(Letters, finds_large_letters_too) {
  const auto line = best_line(scene("DOOR", {250, 300}, 3.0));
  EXPECT_NEAR(line.height, text_box("DOOR", {250, 300}, 3.0).height, 6);
}

TEST(Letters, finds_what_is_bright_on_dark_and_says_so) {
  const auto line = best_line(cv::Scalar::all(255) - scene("HELLO ROBOT"));
  EXPECT_TRUE(line.is_bright);
  EXPECT_NEAR(line.width(), text_box("HELLO ROBOT").width, 6);
}

TEST(Letters, a_block_has_its_lines_from_top_to_bottom) {
  cv::Mat image = scene("HELLO ROBOT", {300, 200});
  scene("HOW ARE YOU", {300, 255}).rowRange(232, 320).copyTo(image.rowRange(232, 320));
  scene("FAR AWAY", {300, 400}).rowRange(350, 420).copyTo(image.rowRange(350, 420));
  const auto block = block_of_best(find_text_lines(image));
  ASSERT_EQ(block.size(), 2U);
  EXPECT_NEAR(block[0].middle().y, 189, 5);
  EXPECT_NEAR(block[1].middle().y, 244, 5);
  EXPECT_TRUE(block_of_best({}).empty());
}

TEST(Letters, a_block_is_as_large_as_its_lines_and_whole_where_they_all_are) {
  TextLine upper, lower;
  upper.corners = {cv::Point2f(10, 10), {110, 12}, {110, 32}, {10, 30}};
  lower.corners = {cv::Point2f(40, 50), {150, 50}, {150, 70}, {40, 70}};
  EXPECT_EQ(box_of({upper}), cv::Rect2f(10, 10, 100, 22));
  EXPECT_EQ(box_of({upper, lower}), cv::Rect2f(10, 10, 140, 60));
  EXPECT_TRUE(is_whole({upper, lower}));
  lower.is_whole = false;
  EXPECT_FALSE(is_whole({upper, lower}));
}

TEST(Letters, finds_nothing_where_nothing_is_written) {
  for (int seed = 0; seed < 5; ++seed) {
    cv::Mat image = scene("");
    add_grain(image, 20, seed);
    EXPECT_TRUE(find_text_lines(image).empty()) << seed;
  }
  EXPECT_TRUE(find_text_lines(cv::Mat(600, 800, CV_8U, cv::Scalar(128))).empty());
  EXPECT_TRUE(find_text_lines(cv::Mat(3, 2, CV_8U, cv::Scalar(128))).empty());
  cv::Mat grains(600, 800, CV_8UC3);
  cv::randu(grains, 0, 255);
  EXPECT_TRUE(find_text_lines(grains).empty());
}

TEST(Letters, a_line_at_the_edge_of_the_image_is_not_whole) {
  cv::Mat image = scene("HELLO ROBOT");
  const auto box = text_box("HELLO ROBOT");
  const auto line = best_line(image.colRange(box.x + box.width / 3, image.cols));
  EXPECT_FALSE(line.is_whole);
}

TEST(Letters, a_dash_and_a_stop_belong_to_the_line) {
  const auto line = best_line(scene("-AB12."));
  EXPECT_NEAR(line.width(), text_box("-AB12.").width, 6);
}

TEST(Letters, a_line_ends_at_the_frame_of_its_board) {
  cv::Mat image = scene("HELLO ROBOT");
  const auto box = text_box("HELLO ROBOT");
  // Behind the board, near its frame, is an object that resembles a letter.
  const int x = box.br().x + box.height + 6;
  cv::rectangle(image, {x - 3, box.y - 10, 60, 45}, {240, 240, 235}, cv::FILLED);
  cv::putText(image, "S", {x, box.br().y}, cv::FONT_HERSHEY_DUPLEX, 1, {20, 20, 25}, 2,
              cv::LINE_AA);
  const auto line = best_line(image);
  EXPECT_NEAR(line.width(), box.width, 6);
}

TEST(Letters, straightens_what_is_turned) {
  cv::Mat image = scene("HELLO ROBOT", {300, 300}), turned;
  const auto turn = cv::getRotationMatrix2D({400, 300}, 8, 1);
  cv::warpAffine(image, turned, turn, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  const auto line = best_line(turned);
  EXPECT_NEAR(line.width(), text_box("HELLO ROBOT").width, 8);
  const cv::Mat straight = straighten(turned, line, 40);
  // Level: the rows above and below the letters are white.
  EXPECT_GT(cv::mean(straight.rowRange(2, 16))[0], 245);
  EXPECT_GT(cv::mean(straight.rowRange(straight.rows - 16, straight.rows - 2))[0], 240);
  EXPECT_LT(cv::mean(straight.rowRange(24, straight.rows - 24))[0], 220);
  EXPECT_NEAR(straight.rows, 88, 1);
}

TEST(Letters, noise_is_measured_in_spite_of_edges) {
  for (double deviation : {2.0, 10.0, 20.0}) {
    cv::Mat image = scene("HELLO ROBOT");
    add_grain(image, deviation, 1);
    cv::Mat green;
    cv::extractChannel(image, green, 1);
    EXPECT_NEAR(noise_of(green), deviation, 0.1 * deviation + 0.3);
  }
}

}  // namespace
}  // namespace hc::vision
