// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <opencv2/imgproc.hpp>

namespace {

// By the shapes of common sans serif letters: the width of a 0 by its height, which an O exceeds,
// and how much of a region is ink, where one of two letters has a stroke and the other has none.
constexpr double kNarrow = 0.755, kFilled = 0.45, kTouched = 0.38, kTail = 0.2;
constexpr double kStem = 0.75;  // how much narrower than elsewhere a stem may be
constexpr double kWide =
    1.35;  // by its height, of the highest: what is wider are letters that touch
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

const cv::Rect2d kFork(0.42, 0.42, 0.16, 0.08);  // of a Y, where a V is open
constexpr double kForked = 0.65;

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

constexpr std::string_view kRound = "035689BOQS";  // what the sides tell from one another
constexpr std::string_view kAlike[] = {"0OQ9", "1I!", "2Z", "35S9", "368BES", "4A", "VY"};
constexpr double kSide = 0.45;         // how much of a side is ink where there is a stroke
constexpr int kInk[] = {128, 96, 64};  // what is darker is ink; less of it where letters touch

/// Whether a glyph has strokes at its four sides, as displays of seven segments have.
struct Sides {
  explicit Sides(const cv::Mat& glyph)
      : top_left(ink_in(glyph, {0, 0.24, 0.3, 0.12}) > kSide),
        top_right(ink_in(glyph, {0.7, 0.24, 0.3, 0.12}) > kSide),
        bottom_left(ink_in(glyph, {0, 0.62, 0.3, 0.12}) > kSide),
        bottom_right(ink_in(glyph, {0.7, 0.62, 0.3, 0.12}) > kSide) {}
  bool top_left, top_right, bottom_left, bottom_right;
};

/// Which round letter or digit a glyph is that was read as one: one of those which look alike to
/// readers of whole lines. O stands for 0, O and Q, S for 5 and S, and B for 8 and B.
char by_sides(const cv::Mat& glyph, char letter) {
  const Sides is(glyph);
  const bool has_middle = ink_in(glyph, {0.3, 0.42, 0.4, 0.16}) > kFilled;
  if (!is.bottom_right)
    return is.top_left && has_middle && is.bottom_left && !is.top_right ? 'E' : letter;
  if (!is.top_left) return is.bottom_left ? letter : '3';
  if (!is.bottom_left) return is.top_right ? '9' : 'S';
  if (!is.top_right) return '6';
  return has_middle ? 'B' : 'O';
}

/// Whether a glyph is one stroke from top to bottom, where a ! has a gap above its dot, or a narrow
/// place at least.
bool is_whole(const cv::Mat& glyph) {
  double least = 1, dot = 0;
  for (int y = glyph.rows / 2; y < glyph.rows; ++y) {
    const double ink = ink_in(glyph.row(y), {0, 0, 1, 1});
    if (y < glyph.rows * 17 / 20)
      least = std::min(least, ink);
    else
      dot = std::max(dot, ink);
  }
  return least > kStem * dot;
}

/// The column of two glyphs that touch in which there is the least ink, not near their ends.
int thinnest(const cv::Mat& glyphs) {
  int best = glyphs.cols / 2;
  double most = -1;
  for (int x = glyphs.cols / 4; x < glyphs.cols * 3 / 4; ++x) {
    const double light = cv::mean(glyphs.col(x))[0];
    if (light > most) best = x;
    most = std::max(most, light);
  }
  return std::max(1, best);
}

bool are_alike(char a, char b) {
  return std::any_of(std::begin(kAlike), std::end(kAlike), [&](auto alike) {
    return alike.find(a) != alike.npos && alike.find(b) != alike.npos;
  });
}

}  // namespace

std::vector<cv::Rect> find_letters(const cv::Mat& line, int darker) {
  cv::Mat ink = line < darker, labels, stats, middles;
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
  int height = 0;
  for (const auto& box : boxes) {
    height = std::max(height, box.height);
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
  // What is too wide are letters that touch: they are parted where there is the least ink.
  for (std::size_t i = 0; i < letters.size(); ++i)
    while (letters[i].width > kWide * height) {
      auto& first = letters[i];
      const int cut = thinnest(line(first));
      cv::Rect second = first;
      first.width = cut;
      second.x += cut;
      second.width -= cut;
      letters.insert(letters.begin() + static_cast<std::ptrdiff_t>(i) + 1, second);
    }
  return letters;
}

char by_shape(const cv::Mat& glyph, char letter) {
  if (kRound.find(letter) != kRound.npos) letter = by_sides(glyph, letter);
  switch (letter) {
    case '0':
    case 'O':
    case 'Q':
      if (ink_in(glyph, kBottomRight) - ink_in(glyph, kBottomLeft) > kTail) return 'Q';
      return glyph.cols < kNarrow * glyph.rows ? '0' : 'O';
    case '4':
    case 'A':
      return ink_in(glyph, kBottomLeft) > kSide / 2 ? 'A' : '4';
    case 'V':
    case 'Y':
      return ink_in(glyph, kFork) > kForked ? 'Y' : 'V';
    case 'E':
      return Sides(glyph).bottom_right ? '6' : 'E';
    case '!':
      if (!is_whole(glyph)) return '!';
      [[fallthrough]];
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

namespace {

/// How many letters of a text their glyphs contradict; spaces have none.
std::size_t contradictions(const cv::Mat& line, const std::vector<cv::Rect>& letters,
                           const std::string& text) {
  std::size_t count = 0, next = 0;
  for (const char letter : text) {
    if (letter == ' ') continue;
    if (next == letters.size()) break;
    if (by_shape(line(letters[next++]), letter) != letter) ++count;
  }
  return count;
}

/// Takes out letters that were read twice, as one that could not decide says both, until there are
/// as many as there are glyphs; gives nothing where that cannot be.
std::optional<std::string> without_twice(const cv::Mat& line, const std::vector<cv::Rect>& letters,
                                         std::string text) {
  const auto spaces = static_cast<std::size_t>(std::count(text.begin(), text.end(), ' '));
  while (text.size() > letters.size() + spaces) {
    std::optional<std::string> best;
    std::size_t fewest = 0;
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
      if (text[i] == text[i + 1] || !are_alike(text[i], text[i + 1])) continue;
      for (const std::size_t which : {i, i + 1}) {
        std::string shorter = text;
        shorter.erase(which, 1);
        const auto count = contradictions(line, letters, shorter);
        if (best && count >= fewest) continue;
        best = shorter;
        fewest = count;
      }
    }
    if (!best) return std::nullopt;
    text = *best;
  }
  if (text.size() < letters.size() + spaces) return std::nullopt;
  return text;
}

}  // namespace

std::string by_shape(const cv::Mat& line, const std::string& text) {
  std::vector<cv::Rect> letters;
  std::optional<std::string> settled;
  for (const int darker : kInk) {
    auto found = find_letters(line, darker);
    auto shorter = without_twice(line, found, text);
    if (!shorter || (settled && settled->size() >= shorter->size())) continue;
    settled = std::move(shorter);
    letters = std::move(found);
    if (settled->size() == text.size()) break;
  }
  if (!settled) return text;
  const auto gap_before = [&](std::size_t i) { return letters[i].x - letters[i - 1].br().x; };
  std::string spaced;
  std::size_t next = 0;
  for (const char letter : *settled) {
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
