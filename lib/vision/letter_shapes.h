// SPDX-License-Identifier: Apache-2.0
#pragma once
// Corrects Tesseract's errors in words outside its dictionary, such as codes, by the shapes of the
// letters, only where these are unambiguous in all common fonts. Wrong letters in 20 codes on the
// simulated board: 0.0 % with it and 5.8 % without; at a noise of 20, 1.0 % and 13.9 %
// (tests/pipes/read_test.py).

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// An ASCII letter as read.
struct Letter {
  char letter = ' ';
  double confidence = 0;     ///< [%]
  bool begins_word = false;  ///< after a space, or first
  bool is_known = false;     ///< its word is in a dictionary
  int x = 0;                 ///< its centre, about [px]
};

struct Reading {
  std::string text;             ///< UTF-8, without space around it; may be empty
  double confidence = 0;        ///< 0 … 1
  std::vector<Letter> letters;  ///< of the text; empty if one is not ASCII
};

/// The boxes of the letters of a straight line, from left to right; parts above one another, as in
/// a !, are one box.
/// @param line  (H, W) u8, black on white. @param darker  pixels below this are ink.
std::vector<cv::Rect> find_letters(const cv::Mat& line, int darker = 128);

/// The letter of a glyph that was read as `letter`: O or 0 by its roundness; 5, S or 3 if its left
/// side is straight, bulges or is open; Q or 9 by the height of its hole; I for a bar; 1 for an I
/// with a flag; otherwise `letter`.
/// @param glyph  cut out, (H, W) u8, black on white.
char by_shape(const cv::Mat& glyph, char letter);

/// A corrected reading.
struct Correction {
  std::string text;
  int odd = 0;  ///< letters without their own glyph, and glyphs without a letter
};

/// Corrects a reading: drops the less confident of two similar letters read from one glyph; puts
/// spaces at wide gaps; in upper case, decides letters of words outside the dictionary by shape.
/// @param line  the image that was read, (H, W) u8, black on white.
Correction by_shape(const cv::Mat& line, const Reading& reading, bool upper_case = true);

}  // namespace hc::vision
