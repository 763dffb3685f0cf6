// SPDX-License-Identifier: Apache-2.0
// Boards in common fonts under various conditions: bright on dark, faint, small, out of focus,
// rotated, from the side, in several lines.
#include "block.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <opencv2/freetype.hpp>
#include <opencv2/imgproc.hpp>

namespace {

struct Look {
  int ink = 20, ground = 240;
  int height = 24;             // of capital letters [px]
  double blur = 0, noise = 2;  // standard deviations [px], [of 255]
  double roll = 0, yaw = 0;    // [°]
};

using Text = std::vector<std::string>;

const char* const kFonts[] = {"liberation/LiberationSans-Regular",
                              "liberation/LiberationSans-Bold",
                              "liberation/LiberationMono-Regular",
                              "liberation/LiberationSerif-Regular",
                              "dejavu/DejaVuSans",
                              "dejavu/DejaVuSans-Bold"};

/// A board on a grey wall, (600, 800, 3) u8, drawn at twice the size.
cv::Mat draw(const Text& lines, const std::string& font, const Look& look) {
  auto letters = cv::freetype::createFreeType2();
  letters->loadFontData("/usr/share/fonts/truetype/" + font + ".ttf", 0);
  cv::Mat image(1200, 1600, CV_8UC3, cv::Scalar(150, 155, 150));
  const int size = static_cast<int>(2 * look.height / 0.72), step = size * 27 / 20;  // of an em
  std::vector<int> widths;
  int below = 0;
  for (const auto& line : lines)
    widths.push_back(letters->getTextSize(line, size, -1, &below).width);
  const int wide = *std::max_element(widths.begin(), widths.end());
  const int high = step * static_cast<int>(lines.size());
  cv::rectangle(image,
                {800 - wide / 2 - size, 600 - high / 2 - size / 2, wide + 2 * size, high + size},
                cv::Scalar::all(look.ground), cv::FILLED);
  for (std::size_t i = 0; i < lines.size(); ++i)
    letters->putText(image, lines[i],
                     {800 - widths[i] / 2, 600 - high / 2 + size + step * static_cast<int>(i)},
                     size, cv::Scalar::all(look.ink), -1, cv::LINE_AA, true);
  cv::Mat turn = cv::getRotationMatrix2D({800, 600}, look.roll, 1), turned, seen;
  const double narrow = std::cos(look.yaw * CV_PI / 180);
  turn.row(0) *= narrow;
  turn.at<double>(0, 2) += 800 * (1 - narrow);
  turned = image;
  if (look.roll != 0 || look.yaw != 0)
    cv::warpAffine(image, turned, turn, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::resize(turned, seen, {800, 600}, 0, 0, cv::INTER_AREA);
  if (look.blur > 0) cv::GaussianBlur(seen, seen, {}, look.blur);
  static std::map<double, cv::Mat> noises;  // by deviation; cached because they are slow
  cv::Mat& noise = noises[look.noise];
  if (noise.empty()) {
    noise.create(seen.size(), CV_16SC3);
    cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0, look.noise);
  }
  cv::Mat sum;
  cv::add(seen, noise, sum, cv::noArray(), CV_8U);
  return sum;
}

/// A board of 262 by 63 pixels with OpenCV's stroke fonts, as in the simulated room.
cv::Mat draw_strokes(const std::string& text, double noise) {
  constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
  cv::Mat board(240, 1000, CV_8UC3, cv::Scalar(245, 245, 240)), seen, sum;
  int below = 0;
  const auto large = cv::getTextSize(text, kFont, 10, 1, &below);
  const double scale = std::min(9000.0 / large.width, 10 * 112.0 / (large.height + below));
  const int stroke = static_cast<int>(2.6 * scale);
  const auto size = cv::getTextSize(text, kFont, scale, stroke, &below);
  cv::putText(board, text, {(1000 - size.width) / 2, (240 + size.height) / 2}, kFont, scale,
              {20, 20, 25}, stroke, cv::LINE_AA);
  cv::resize(board, seen, {262, 63}, 0, 0, cv::INTER_AREA);
  cv::Mat image(600, 800, CV_8UC3, cv::Scalar(150, 155, 150));
  seen.copyTo(image(cv::Rect(269, 269, 262, 63)));
  cv::Mat grains(image.size(), CV_16SC3);
  cv::RNG(7).fill(grains, cv::RNG::NORMAL, 0, noise);
  cv::add(image, grains, sum, cv::noArray(), CV_8U);
  return sum;
}

/// The share of texts in all fonts read without an error [%].
int read(const std::vector<Text>& texts, const Look& look, bool upper_case = true) {
  static std::map<bool, BlockReader> readers;
  if (!readers.count(upper_case))
    readers.emplace(upper_case, std::move(*BlockReader::make("eng", upper_case)));
  int right = 0, all = 0;
  for (const auto* font : kFonts)
    for (const auto& text : texts) {
      const auto image = draw(text, font, look);
      const auto block = BlockReader::find(image, 0.4);
      const auto reading = readers.at(upper_case).read(image, block);
      std::string truth;
      for (const auto& line : text) truth += (truth.empty() ? "" : " ") + line;
      ++all;
      right += reading.text == truth ? 1 : 0;
    }
  return 100 * right / all;
}

const std::vector<Text> kUpper = {{"READ A TEXT"}, {"I AM HERE"}, {"STOP AT LAB 4"}};
const std::vector<Text> kLower = {
    {"Look at the red ball"}, {"happy people play"}, {"no smoking in this room, please"}};

TEST(Block, is_read_clean_small_and_noisy) {
  EXPECT_GE(read(kUpper, {}), 94);  // one of 18
  EXPECT_GE(read(kUpper, {.height = 12}), 94);
  EXPECT_GE(read(kUpper, {.height = 60}), 94);
  EXPECT_GE(read(kUpper, {.noise = 20}), 94);
}

TEST(Block, may_be_bright_on_dark_and_faint) {
  EXPECT_GE(read(kUpper, {.ink = 230, .ground = 30}), 94);
  EXPECT_GE(read(kUpper, {.ink = 230, .ground = 30, .height = 12}), 94);
  EXPECT_GE(read(kUpper, {.ink = 110, .ground = 170}), 90);
  EXPECT_GE(read(kUpper, {.ink = 140, .ground = 170}), 90);
  EXPECT_GE(read(kUpper, {.ink = 170, .ground = 110}), 94);
}

TEST(Block, may_be_out_of_focus) {
  EXPECT_GE(read(kUpper, {.blur = 2}), 70);
}

TEST(Block, may_be_turned_or_seen_from_the_side) {
  EXPECT_GE(read(kUpper, {.roll = 4}), 90);
  EXPECT_GE(read(kUpper, {.roll = 10}), 90);
  EXPECT_GE(read(kUpper, {.roll = 15}), 94);
  EXPECT_GE(read(kUpper, {.roll = -15}), 88);
  EXPECT_GE(read(kUpper, {.yaw = 45}), 90);
}

TEST(Block, may_have_several_lines) {
  const std::vector<Text> texts = {
      {"HELLO", "ROBOT HEAD"}, {"ROOM 27", "STOP AT LAB 4"}, {"PLEASE", "CLOSE THE", "DOOR"}};
  EXPECT_GE(read(texts, {}), 83);
  EXPECT_GE(read(texts, {.ink = 230, .ground = 30}), 83);
}

TEST(Block, may_have_several_lines_and_be_turned) {
  const std::vector<Text> texts = {
      {"PLEASE", "CLOSE THE", "DOOR"}, {"ROOM 27", "STOP AT", "LAB 4"}, {"ONE", "TWO", "THREE"}};
  EXPECT_GE(read(texts, {}), 94);
  EXPECT_GE(read(texts, {.roll = 10}), 83);
  EXPECT_GE(read(texts, {.roll = -15}), 77);
}

TEST(Block, may_be_of_small_letters_to_the_end_of_the_line) {
  EXPECT_GE(read(kLower, {.height = 16}, false), 94);
  EXPECT_GE(read(kLower, {.height = 12}, false), 90);
  EXPECT_GE(read(kLower, {.ink = 230, .ground = 30, .height = 16}, false), 90);
  EXPECT_GE(read({{"I am here"}, {"EXIT -> 12.50"}, {"Mind the gap!"}}, {}, false), 80);
}

// Texts that were read wrong in the simulated head: a letter read twice beside two that touch, one
// missing, a space where there is none.
TEST(Block, codes_are_read_letter_by_letter) {
  auto reader = BlockReader::make("eng", true);
  ASSERT_TRUE(reader) << reader.error().text();
  for (const double noise : {2.0, 20.0})
    for (const char* const code :
         {"LAV56X", "F90WRA", "T5ZTLA4 PO3FAN0W", "EBQID5I 9AHG5QO8", "3WSH470 RI7E9URP", "5ASDRY1",
          "VW9CXTIJ 2D03I", "IBZJ9JQF", "Y2H0NULX 6Q9KJ0", "XG6PDW9S 2DK", "OIYIWEWP"}) {
      const auto image = draw_strokes(code, noise);
      const auto block = BlockReader::find(image, 0.4);
      EXPECT_EQ(reader->read(image, block).text, code) << noise;
    }
}

TEST(Block, may_be_a_crop_with_letters_at_its_border) {
  auto reader = BlockReader::make("eng", false);
  ASSERT_TRUE(reader) << reader.error().text();
  for (const auto& [ink, ground] : {std::pair(30, 200), {200, 30}, {140, 100}}) {
    const auto image = draw({"Stationery"}, kFonts[3], {.ink = ink, .ground = ground});
    const auto line = hc::vision::find_text_lines(image).at(0).box();
    const cv::Mat crop = image(cv::Rect(line) + cv::Point(-2, -2) + cv::Size(4, 12)).clone();
    const auto block = BlockReader::find(crop, 0.4);
    ASSERT_EQ(block.size(), 1U);
    EXPECT_EQ(hc::vision::box_of(block).width, static_cast<float>(crop.cols));
    EXPECT_EQ(reader->read(crop, block).text, "Stationery") << ink;
  }
  EXPECT_TRUE(BlockReader::find(cv::Mat(40, 200, CV_8UC3, cv::Scalar(90, 80, 70)), 0.4).empty());
}

TEST(Block, is_read_when_it_is_whole_and_due_by_the_times_of_images) {
  using namespace std::chrono_literals;
  constexpr double kRate = 4;
  auto reader = BlockReader::make("eng", true);
  ASSERT_TRUE(reader) << reader.error().text();
  const auto image = draw_strokes("LAV56X", 2);
  auto block = BlockReader::find(image, 0.4);
  ASSERT_FALSE(block.empty());
  const auto is_read = [&](int time, double rate) {
    return reader->read_when_due(image, block, hc::Time(time * 1ms), rate).has_value();
  };
  block.front().is_whole = false;
  EXPECT_FALSE(is_read(1000, kRate));
  block.front().is_whole = true;
  EXPECT_TRUE(is_read(1010, kRate)) << "what was not whole was not read";
  EXPECT_FALSE(is_read(1259, kRate));
  EXPECT_TRUE(reader->read_when_due(image, block, hc::Time(1260ms - 500us), kRate))
      << "times differ by half a millisecond";
  EXPECT_TRUE(is_read(1270, 0)) << "all";
  EXPECT_FALSE(is_read(1280, kRate));
  EXPECT_TRUE(is_read(1000, kRate)) << "a recording that starts over";
}

}  // namespace
