// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tells apart block letters and digits that look alike: 0 O Q 9, 1 I !, 2 Z, 3 5 9 S, 4 A, 6 8 B E,
// V Y. A recogniser that has learned words takes what is likelier beside its neighbours; where
// letters and digits are mixed, the shape alone says which it is. Pure.

#include <string>
#include <vector>

#include <opencv2/core.hpp>

/// The letters of a line, from the left: a box around each, what stands one above the other in one.
///
/// @param line  (H, W) u8, black on white.
/// @param darker  what is ink; less parts letters that touch.
std::vector<cv::Rect> find_letters(const cv::Mat& line, int darker = 128);

/// What one letter is by its shape, in upright letters without serifs.
///
/// @param glyph  (H, W) u8, black on white, cut off around the letter.
/// @param letter  what it was taken for.
/// @returns  that, or the one that looks like it.
char by_shape(const cv::Mat& glyph, char letter);

/// The same for all letters of a text. Where it has both of two that look alike for one letter, one
/// of them is taken out, so that the fewest others contradict their shapes. A text whose letters
/// are not as many then as those that stand apart in the line is left as it is. A space between
/// letters that are close is taken out.
std::string by_shape(const cv::Mat& line, const std::string& text);
