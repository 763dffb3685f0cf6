// SPDX-License-Identifier: Apache-2.0
// Boards in common fonts, as they are seen: bright on dark, faint, small, out of focus, turned,
// from the side, in several lines.
#include "block.h"

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
  cv::warpAffine(image, turned, turn, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::resize(turned, seen, {800, 600}, 0, 0, cv::INTER_AREA);
  if (look.blur > 0) cv::GaussianBlur(seen, seen, {}, look.blur);
  cv::Mat noise(seen.size(), CV_16SC3), sum;
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0, look.noise);
  cv::add(seen, noise, sum, cv::noArray(), CV_8U);
  return sum;
}

/// How many of some texts in all fonts are read without an error, [%].
int read(const std::vector<Text>& texts, const Look& look, bool upper_case = true) {
  static std::map<bool, Recogniser> recognisers;
  if (!recognisers.count(upper_case))
    recognisers.emplace(upper_case, std::move(*Recogniser::make("eng", upper_case)));
  int right = 0, all = 0;
  for (const auto* font : kFonts)
    for (const auto& text : texts) {
      const auto image = draw(text, font, look);
      const auto block = hc::vision::block_of_best(hc::vision::find_text_lines(image));
      const auto reading = read_block(recognisers.at(upper_case), image, block, upper_case);
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
  EXPECT_GE(read(kUpper, {.yaw = 45}), 90);
}

TEST(Block, may_have_several_lines) {
  const std::vector<Text> texts = {
      {"HELLO", "ROBOT HEAD"}, {"ROOM 27", "STOP AT LAB 4"}, {"PLEASE", "CLOSE THE", "DOOR"}};
  EXPECT_GE(read(texts, {}), 60);
  EXPECT_GE(read(texts, {.ink = 230, .ground = 30}), 60);
}

TEST(Block, may_be_of_small_letters_to_the_end_of_the_line) {
  EXPECT_GE(read(kLower, {.height = 16}, false), 94);
  EXPECT_GE(read(kLower, {.height = 12}, false), 90);
  EXPECT_GE(read(kLower, {.ink = 230, .ground = 30, .height = 16}, false), 90);
  EXPECT_GE(read({{"I am here"}, {"EXIT -> 12.50"}, {"Mind the gap!"}}, {}, false), 80);
}

}  // namespace
