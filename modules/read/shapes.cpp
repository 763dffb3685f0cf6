// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#include <algorithm>
#include <string_view>

#include <opencv2/imgproc.hpp>

namespace {

// By the shapes of common sans serif letters: the width of a 0 by its height, which an O exceeds,
// and how much of a region is ink, where one of two letters has a stroke and the other has none.
constexpr double kNarrow = 0.755, kFilled = 0.45, kTouched = 0.38, kTail = 0.2;
constexpr double kGap = 0.55;  // between words, at least, by a letter's height

/// How much of a region is ink, 0 … 1. It is given as parts of the glyph's width and height.
double ink_in(const cv::Mat& glyph, const cv::Rect2d& part) {
  const cv::Rect all({}, glyph.size());
  cv::Rect region(cvRound(part.x * glyph.cols), cvRound(part.y * glyph.rows),
                  std::max(1, cvRound(part.width * glyph.cols)),
                  std::max(1, cvRound(part.height * glyph.rows)));
  region &= all;
  return region.empty() ? 0 : 1 - cv::mean(glyph(region))[0] / 255;
}

const cv::Rect2d kTopLeft(0, 0, 0.2, 0.12), kTopRight(0.8, 0, 0.2, 0.12);
const cv::Rect2d kBottomLeft(0, 0.84, 0.22, 0.16), kBottomRight(0.78, 0.84, 0.22, 0.16);
const cv::Rect2d kBelowTheBar(0.7, 0.2, 0.3, 0.14);  // of a 5, where an S begins

/// The leftmost column with ink within rows of a glyph, given as parts of its height.
int left_of(const cv::Mat& glyph, double from, double to) {
  const int first = cvRound(from * glyph.rows);
  const int last = std::max(first + 1, cvRound(to * glyph.rows));
  for (int x = 0; x < glyph.cols; ++x) {
    int ink = 0;
    for (int y = first; y < last; ++y) ink += glyph.at<std::uint8_t>(y, x) < 128 ? 1 : 0;
    // More than what noise makes; fewer than the rows, since strokes slope.
    if (ink >= std::max(2, (last - first) / 4)) return x;
  }
  return glyph.cols;
}

/// Whether a stroke sticks out to the left of the stem, at the top, as of a 1.
bool has_flag(const cv::Mat& glyph) {
  return left_of(glyph, 0.55, 0.85) - left_of(glyph, 0.08, 0.45) > 0.08 * glyph.rows;
}

constexpr std::string_view kAlike[] = {"0OQ", "1I", "2Z", "5S", "8BS", "4A"};

bool are_alike(char a, char b) {
  return std::any_of(std::begin(kAlike), std::end(kAlike), [&](auto pair) {
    return pair.find(a) != pair.npos && pair.find(b) != pair.npos;
  });
}

}  // namespace

std::vector<cv::Rect> find_letters(const cv::Mat& line) {
  cv::Mat ink = line < 128, labels, stats, middles;
  const int count = cv::connectedComponentsWithStats(ink, labels, stats, middles, 8);
  std::vector<cv::Rect> boxes;
  for (int label = 1; label < count; ++label) {
    const int* of = stats.ptr<int>(label);
    if (of[cv::CC_STAT_AREA] * 200 < line.rows * line.rows) continue;  // a speck
    boxes.emplace_back(of[cv::CC_STAT_LEFT], of[cv::CC_STAT_TOP], of[cv::CC_STAT_WIDTH],
                       of[cv::CC_STAT_HEIGHT]);
  }
  std::sort(boxes.begin(), boxes.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  std::vector<cv::Rect> letters;
  for (const auto& box : boxes) {
    if (!letters.empty()) {
      auto& last = letters.back();
      const int shared = std::min(last.br().x, box.br().x) - box.x;
      if (2 * shared > std::min(last.width, box.width)) {
        last |= box;
        continue;
      }
    }
    letters.push_back(box);
  }
  return letters;
}

char by_shape(const cv::Mat& glyph, char letter) {
  switch (letter) {
    case '0':
    case 'O':
    case 'Q':
      if (ink_in(glyph, kBottomRight) - ink_in(glyph, kBottomLeft) > kTail) return 'Q';
      return glyph.cols < kNarrow * glyph.rows ? '0' : 'O';
    case '1':
    case 'I':
      return has_flag(glyph) ? '1' : 'I';
    case '2':
    case 'Z':
      return ink_in(glyph, kTopRight) > kFilled ? 'Z' : '2';
    case '5':
    case 'S':
      // By how thick the strokes are.
      return ink_in(glyph, kBelowTheBar) < kTouched * ink_in(glyph, {0, 0, 1, 1}) ? '5' : 'S';
    case '8':
    case 'B':
      return ink_in(glyph, kTopLeft) > kFilled ? 'B' : '8';
    default:
      return letter;
  }
}

std::string by_shape(const cv::Mat& line, const std::string& text) {
  const auto letters = find_letters(line);
  const auto spaces = static_cast<std::size_t>(std::count(text.begin(), text.end(), ' '));
  std::string settled = text;
  // One that could not decide says both.
  for (std::size_t i = 0; i + 1 < settled.size() && settled.size() > letters.size() + spaces;)
    if (settled[i] != settled[i + 1] && are_alike(settled[i], settled[i + 1]))
      settled.erase(i, 1);
    else
      ++i;
  if (settled.size() != letters.size() + spaces) return text;
  const auto gap_before = [&](std::size_t i) { return letters[i].x - letters[i - 1].br().x; };
  std::string spaced;
  std::size_t next = 0;
  for (char letter : settled) {
    if (letter == ' ') {
      // What stands close together is one word, whatever it means.
      if (next > 0 && next < letters.size() && gap_before(next) < kGap * letters[next].height)
        continue;
      spaced += letter;
    } else {
      spaced += by_shape(line(letters[next++]), letter);
    }
  }
  return spaced;
}
