// SPDX-License-Identifier: Apache-2.0
#pragma once
// What Tesseract gets wrong in words that are no words, such as codes, set right by the shapes of
// the letters: where they leave no doubt, in any common font, and nowhere else. Of the letters of
// 20 codes on the simulated board 0.0 % are wrong with it and 5.8 % without, at a noise of 20 1.0 %
// and 13.9 % (tests/pipes/read_test.py).

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// A letter of ASCII that was read.
struct Letter {
  char letter = ' ';
  double confidence = 0;     ///< [%]
  bool begins_word = false;  ///< preceded by a space, or nothing
  bool is_known = false;     ///< its word is in a dictionary
  int x = 0;                 ///< its middle, about [px]
};

struct Reading {
  std::string text;             ///< UTF-8, without space around it; may be empty
  double confidence = 0;        ///< 0 … 1
  std::vector<Letter> letters;  ///< of the text; none where one is not ASCII
};

/// The boxes of the letters of a straight line, from left to right; parts above one
/// another, as the parts of a !, is one. @param line (H, W) u8, black on white.
/// @param darker  what is darker is ink.
std::vector<cv::Rect> find_letters(const cv::Mat& line, int darker = 128);

/// What a glyph is that was read as `letter`: O or 0 by how round it is, 5, S or 3 by whether it
/// is straight, protrudes or is open on its left, Q or 9 by how low its hole is, I where it is
/// nothing but a bar, 1 where an I has a flag; otherwise `letter`.
/// @param glyph  cut out, (H, W) u8, black on white.
char by_shape(const cv::Mat& glyph, char letter);

/// A reading, set right.
struct Correction {
  std::string text;
  int odd = 0;  ///< letters without a glyph of their own, and glyphs of which no letter was read
};

/// Sets a reading right: of two letters that look alike and were read of one glyph, the less sure
/// one is dropped; spaces are where gaps are wide; and in upper case, each letter of a word that is
/// in no dictionary is by its shape.
/// @param line  what was read, (H, W) u8, black on white.
Correction by_shape(const cv::Mat& line, const Reading& reading, bool upper_case = true);

}  // namespace hc::vision
