// SPDX-License-Identifier: Apache-2.0
#include <vision/letter_shapes.h>

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

Reading reading(const std::string& text, double confidence = 99, bool is_known = false) {
  Reading reading{text, 0.9, {}};
  bool begins = true;
  for (const char letter : text) {
    if (letter != ' ') reading.letters.push_back({letter, confidence, begins, is_known});
    begins = letter == ' ';
  }
  return reading;
}

TEST(Shapes, distinguish_what_looks_alike_apart) {
  const std::string text = "0O 5S I1 9Q", wrong = "O0 S5 1I Q9";
  for (int font : {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX})
    for (int stroke : {5, 6})
      for (double blur : {0.0, 1.0, 1.5}) {
        const cv::Mat line = written(text, font, stroke, blur);
        EXPECT_EQ(by_shape(line, reading(text)), text) << font << " " << stroke << " " << blur;
        EXPECT_EQ(by_shape(line, reading(wrong)), text) << font << " " << stroke << " " << blur;
      }
}

TEST(Shapes, distinguish_by_its_holes_what_was_taken_for_a_letter_without) {
  for (int font : {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX})
    for (double blur : {0.0, 1.0, 1.5}) {
      EXPECT_EQ(
          by_shape(written("9W 6NH 8U 9K 2H Z7", font, 5, blur), reading("SW ENH SU OK ZH 27")),
          "9W 6NH 8U 9K 2H Z7");
      EXPECT_EQ(by_shape(written("SEY5Z2", font, 5, blur), reading("SEY5Z2")), "SEY5Z2");
    }
}

TEST(Shapes, a_word_in_the_dictionary_stays) {
  const cv::Mat line = written("5TOP", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, reading("STOP", 99, true)), "STOP");
  EXPECT_EQ(by_shape(line, reading("STOP")), "5TOP");
}

TEST(Shapes, an_exclamation_mark_is_no_bar) {
  const cv::Mat line = written("I1!", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, reading("!1!")), "I1!");
}

TEST(Shapes, of_both_for_one_letter_the_surer_one_is_left) {
  const cv::Mat line = written("4B 0K", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  auto both = reading("A4B O0K");
  both.letters[0].confidence = 92;
  both.letters[4].confidence = 93;
  EXPECT_EQ(by_shape(line, both), "4B 0K");
  // What is sure was not read twice, however many letters are seen.
  EXPECT_EQ(by_shape(line, reading("A4B O0K")), "A4B O0K");
}

TEST(Shapes, set_spaces_where_gaps_are_wide) {
  const auto spaced = [](const std::string& truth, const std::string& read, bool upper_case) {
    const cv::Mat line = written(truth, cv::FONT_HERSHEY_DUPLEX, 5, 1);
    auto letters = reading(read);
    const auto boxes = find_letters(line);
    for (std::size_t i = 0; i < std::min(boxes.size(), letters.letters.size()); ++i)
      letters.letters[i].x = boxes[i].x + boxes[i].width / 2;
    return by_shape(line, letters, upper_case);
  };
  EXPECT_EQ(spaced("KMKFJSA B", "KMKF JSA B", true), "KMKFJSA B");
  EXPECT_EQ(spaced("I AM HERE", "IAM HERE", true), "I AM HERE");
  EXPECT_EQ(spaced("I am here", "lam here", false), "I am here");
}

TEST(Shapes, spaces_stay_where_letters_are_not_where_they_were_read) {
  const cv::Mat line = written("KMKFJSA B", cv::FONT_HERSHEY_DUPLEX, 5, 1);
  EXPECT_EQ(by_shape(line, reading("KMKF JSA B")), "KMKF JSA B");
}

TEST(Shapes, leave_other_letters_as_they_are) {
  const std::string text = "ABCDEFGHJKLMNPQRTUVWXYZ2346789";
  EXPECT_EQ(by_shape(written(text, cv::FONT_HERSHEY_DUPLEX, 5, 1), reading(text)), text);
}

TEST(Shapes, do_nothing_where_letters_cannot_be_counted) {
  const cv::Mat line = written("50", cv::FONT_HERSHEY_DUPLEX, 5, 0);
  EXPECT_EQ(by_shape(line, reading("SOO")), "SOO");
  EXPECT_EQ(by_shape(cv::Mat(80, 100, CV_8U, cv::Scalar(255)), reading("SO")), "SO");
  EXPECT_EQ(by_shape(cv::Mat(80, 100, CV_8U, cv::Scalar(255)), reading("")), "");
}

TEST(Shapes, what_stands_one_above_the_other_is_one_letter) {
  EXPECT_EQ(find_letters(written("A!?", cv::FONT_HERSHEY_DUPLEX, 4, 0)).size(), 3U);
}

TEST(Shapes, a_dash_is_one_letter) {
  EXPECT_EQ(find_letters(written("A-B", cv::FONT_HERSHEY_DUPLEX, 5, 0)).size(), 3U);
}

}  // namespace

}  // namespace hc::vision
