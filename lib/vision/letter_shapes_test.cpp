// SPDX-License-Identifier: Apache-2.0
#include <vision/letter_shapes.h>

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace hc::vision {

namespace {

cv::Mat written(const std::string& text, int font, int stroke, double blur) {
  cv::Mat line(80, 42 * static_cast<int>(text.size()) + 60, CV_8U, cv::Scalar(255));
  cv::putText(line, text, {20, 60}, font, 1.9, cv::Scalar(0), stroke, cv::LINE_AA);
  if (blur > 0) cv::GaussianBlur(line, line, {}, blur);
  return line;
}

/// Positions of consecutive letters of about the same width [px].
std::vector<int> middles_of(const cv::Mat& line, std::size_t letters) {
  // Some touch; there is less ink between them.
  auto boxes = find_letters(line);
  for (int darker = 96; boxes.size() < letters && darker >= 32; darker -= 32)
    boxes = find_letters(line, darker);
  std::vector<int> middles;
  for (std::size_t i = 0; i < letters; ++i)
    if (boxes.size() >= letters)
      middles.push_back(boxes[i].x + boxes[i].width / 2);
    else if (!boxes.empty())
      middles.push_back(boxes.front().x + (boxes.back().br().x - boxes.front().x) *
                                              static_cast<int>(2 * i + 1) /
                                              static_cast<int>(2 * letters));
  middles.resize(letters);
  return middles;
}

/// A reading of a line with the letters at its glyphs: one letter per glyph unless the glyph of
/// each is given.
Reading reading(const cv::Mat& line, const std::string& text,
                const std::vector<std::size_t>& glyphs = {}, bool is_known = false) {
  Reading reading{text, 0.9, {}};
  const auto boxes = find_letters(line);
  const auto spaces = static_cast<std::size_t>(std::count(text.begin(), text.end(), ' '));
  const auto middles = middles_of(line, text.size() - spaces);
  bool begins = true;
  for (const char letter : text) {
    if (letter != ' ') {
      const std::size_t i = reading.letters.size();
      const int x = glyphs.empty() ? middles[i] : boxes[glyphs[i]].x + boxes[glyphs[i]].width / 2;
      reading.letters.push_back({letter, 99, begins, is_known, x});
    }
    begins = letter == ' ';
  }
  return reading;
}

std::string corrected(const cv::Mat& line, const std::string& read) {
  return by_shape(line, reading(line, read)).text;
}

TEST(Shapes, distinguish_what_looks_alike_apart) {
  const std::string text = "0O 5S I1 9Q", wrong = "O0 S5 1I Q9";
  for (int font : {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX})
    for (int stroke : {5, 6})
      for (double blur : {0.0, 1.0, 1.5}) {
        const cv::Mat line = written(text, font, stroke, blur);
        EXPECT_EQ(corrected(line, text), text) << font << " " << stroke << " " << blur;
        EXPECT_EQ(corrected(line, wrong), text) << font << " " << stroke << " " << blur;
      }
}

TEST(Shapes, distinguish_by_its_holes_what_was_taken_for_a_letter_without) {
  for (int font : {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX})
    for (double blur : {0.0, 1.0, 1.5}) {
      EXPECT_EQ(corrected(written("9W 6NH 8U 9K 2H Z7", font, 5, blur), "SW ENH SU OK ZH 27"),
                "9W 6NH 8U 9K 2H Z7");
      EXPECT_EQ(corrected(written("SEY5Z2", font, 5, blur), "SEY5Z2"), "SEY5Z2");
    }
}

TEST(Shapes, a_word_in_the_dictionary_stays) {
  const cv::Mat line = written("5TOP", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, reading(line, "STOP", {}, true)).text, "STOP");
  EXPECT_EQ(corrected(line, "STOP"), "5TOP");
}

TEST(Shapes, an_exclamation_mark_is_no_bar) {
  const cv::Mat line = written("I1!", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(corrected(line, "!1!"), "I1!");
}

TEST(Shapes, of_both_for_one_letter_the_surer_one_is_left) {
  const cv::Mat line = written("4B 0K", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  auto both = reading(line, "A4B O0K", {0, 0, 1, 2, 2, 3});
  both.letters[0].confidence = 92;
  both.letters[4].confidence = 93;
  const auto right = by_shape(line, both);
  EXPECT_EQ(right.text, "4B 0K");
  EXPECT_EQ(right.odd, 2);
}

TEST(Shapes, both_for_one_letter_are_told_from_letters_that_touch) {
  const cv::Mat line = written("LAV56X", cv::FONT_HERSHEY_DUPLEX, 8, 1);
  ASSERT_EQ(find_letters(line).size(), 5U);  // L and A are one
  const auto once = by_shape(line, reading(line, "LAV56X", {0, 0, 1, 2, 3, 4}));
  EXPECT_EQ(once.text, "LAV56X");
  EXPECT_EQ(once.odd, 0);
  auto twice = reading(line, "LAVS56X", {0, 0, 1, 2, 2, 3, 4});
  twice.letters[3].confidence = 97;
  EXPECT_EQ(by_shape(line, twice).text, "LAV56X");
  // Touching letters do not prevent the correction of the others.
  EXPECT_EQ(by_shape(line, reading(line, "LAVS6X", {0, 0, 1, 2, 3, 4})).text, "LAV56X");
}

TEST(Shapes, a_glyph_that_no_letter_was_read_of_is_odd) {
  const cv::Mat line = written("2D03I", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  const auto short_by_one = by_shape(line, reading(line, "2D03"));
  EXPECT_EQ(short_by_one.text, "2D03");
  EXPECT_EQ(short_by_one.odd, 1);
}

TEST(Shapes, letters_are_of_their_glyphs_wherever_about_they_were_read) {
  const cv::Mat line = written("0KS5I1", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  auto shifted = reading(line, "OK5S1I");
  for (auto& letter : shifted.letters) letter.x -= 20;
  const auto right = by_shape(line, shifted);
  EXPECT_EQ(right.text, "0KS5I1");
  EXPECT_EQ(right.odd, 0);
}

TEST(Shapes, set_spaces_where_gaps_are_wide) {
  const auto spaced = [](const std::string& truth, const std::string& read, bool upper_case) {
    const cv::Mat line = written(truth, cv::FONT_HERSHEY_DUPLEX, 5, 1);
    return by_shape(line, reading(line, read), upper_case).text;
  };
  EXPECT_EQ(spaced("KMKFJSA B", "KMKF JSA B", true), "KMKFJSA B");
  EXPECT_EQ(spaced("5ASDRY1", "5ASDRY 1", true), "5ASDRY1");
  EXPECT_EQ(spaced("I AM HERE", "IAM HERE", true), "I AM HERE");
  EXPECT_EQ(spaced("I am here", "lam here", false), "I am here");
}

TEST(Shapes, leave_other_letters_as_they_are) {
  const std::string text = "ABCDEFGHJKLMNPQRTUVWXYZ2346789";
  EXPECT_EQ(corrected(written(text, cv::FONT_HERSHEY_DUPLEX, 5, 1), text), text);
}

TEST(Shapes, do_nothing_where_there_are_no_glyphs) {
  const cv::Mat empty(80, 100, CV_8U, cv::Scalar(255));
  EXPECT_EQ(corrected(empty, "SO"), "SO");
  EXPECT_EQ(by_shape(empty, reading(empty, "SO")).odd, 2);
  EXPECT_EQ(corrected(empty, ""), "");
}

TEST(Shapes, what_stands_one_above_the_other_is_one_letter) {
  EXPECT_EQ(find_letters(written("A!?", cv::FONT_HERSHEY_DUPLEX, 4, 0)).size(), 3U);
}

TEST(Shapes, a_dash_is_one_letter) {
  EXPECT_EQ(find_letters(written("A-B", cv::FONT_HERSHEY_DUPLEX, 5, 0)).size(), 3U);
}

}  // namespace

}  // namespace hc::vision
