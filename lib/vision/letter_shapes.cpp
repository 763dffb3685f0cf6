// SPDX-License-Identifier: Apache-2.0
#include <vision/letter_shapes.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <opencv2/imgproc.hpp>

#include <hc/base/median.h>

namespace hc::vision {

namespace {

// Measured with Liberation Sans, Sans Narrow and Serif, DejaVu Sans and Serif, also condensed and
// bold, and OpenCV's four Hershey fonts with several stroke widths, sharp and blurred. Width /
// height of the stroke's centre line: 0 up to 0.69, O from 0.73, seen from a few degrees to the
// side. Unchanged between these limits. An O of a monospaced font is as narrow as a 0.
constexpr double kNarrow = 0.695, kRound = 0.72;
// Bulge of the left side in the middle of its upper half / width: 5 up to 0.03, S from 0.07.
constexpr double kStraight = 0.045, kBulging = 0.06;
// Centre of the hole from the top / height: 9 up to 0.33, Q from 0.40.
constexpr double kUpper = 0.355, kMiddle = 0.375;
// Cut-off of the upper right corner / width: Z up to 0.05, 2 from 0.14.
constexpr double kCorner = 0.08, kRoundCorner = 0.11;
constexpr double kEven = 0.14;        // asymmetry below which it is an I, not a 1
constexpr double kOpen = -0.2;        // bulge of the open left side of a 3
constexpr double kBar = 0.28;         // width / height of an I without serifs, at most; 1 from 0.33
constexpr double kGap = 1.6;          // / median gap in words; spaces are wider
constexpr double kSpace = 0.75;       // / narrowest space read; wider gaps are spaces
constexpr double kLeastSpace = 0.25;  // / height of capital letters; spaces are wider
// Gaps / median and / height that are a space even if no space was read anywhere.
constexpr double kWideGap = 2.5, kWideSpace = 0.36;
// Maximum share of ink in the upper right of an L, and in a C at the place of a G's bar.
constexpr double kNoInk = 0.03;
// Costs of an unread glyph and of a letter that shares its glyph / height.
constexpr double kUnread = 1, kShared = 1;
// Minimum width of touching letters / sum of their widths; width of slim letters / usual width;
// usual width / height where it cannot be measured.
constexpr double kTouching = 0.75, kSlimWidth = 0.4, kWidth = 0.7;
constexpr std::string_view kSlim = "I1!|.,-'ijlftr";

constexpr std::string_view kAlike[] = {"0OQ9", "1I!", "2Z", "35S9", "368BES", "4A", "VY"};

bool are_alike(char a, char b) {
  return a != b && std::any_of(std::begin(kAlike), std::end(kAlike), [&](auto alike) {
           return alike.find(a) != alike.npos && alike.find(b) != alike.npos;
         });
}

/// The holes of a glyph [px].
std::vector<cv::Rect> holes_of(const cv::Mat& glyph) {
  cv::Mat ground, labels, stats, middles;
  cv::copyMakeBorder(glyph >= 128, ground, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  const int count = cv::connectedComponentsWithStats(ground, labels, stats, middles, 4);
  // Holes are not connected with the ground outside; specks are ignored.
  const int outside = labels.at<std::int32_t>(0, 0);
  std::vector<cv::Rect> holes;
  for (int label = 1; label < count; ++label) {
    const int* of = stats.ptr<int>(label);
    if (label == outside || of[cv::CC_STAT_AREA] * 50 < static_cast<int>(glyph.total())) continue;
    holes.emplace_back(of[cv::CC_STAT_LEFT] - 1, of[cv::CC_STAT_TOP] - 1, of[cv::CC_STAT_WIDTH],
                       of[cv::CC_STAT_HEIGHT]);
  }
  return holes;
}

/// Centre of a hole from the top / height of the glyph.
double middle_of(const cv::Rect& hole, const cv::Mat& glyph) {
  return (hole.y + hole.height / 2.0) / glyph.rows;
}

/// Median left edge of the ink in a range of rows, given as shares of the height [px].
double left_side(const cv::Mat& glyph, double from, double to) {
  const int first = cvRound(from * glyph.rows);
  const int last = std::min(glyph.rows, std::max(first + 1, cvRound(to * glyph.rows)));
  std::vector<double> sides;
  for (int y = first; y < last; ++y) {
    const auto* row = glyph.ptr<std::uint8_t>(y);
    int x = 0;
    while (x < glyph.cols && row[x] >= 128) ++x;
    // Interpolated; white outside the box.
    const double before = x == 0 ? 255 : row[x - 1];
    sides.push_back(x == glyph.cols ? x : x - (128 - row[x]) / std::max(1.0, before - row[x]));
  }
  return median(std::move(sides));
}

/// Bulge of an S or 5 to the left, between the top and the middle / width.
double bulge(const cv::Mat& glyph) {
  const double ends = (left_side(glyph, 0.02, 0.12) + left_side(glyph, 0.3, 0.4)) / 2;
  return 2 * (ends - left_side(glyph, 0.14, 0.26)) / glyph.cols;
}

/// Cut-off of the upper right corner of a 2 or Z / width.
double cut_corner(const cv::Mat& glyph) {
  cv::Mat mirrored;
  cv::flip(glyph, mirrored, 1);
  return left_side(mirrored, 0, 0.08) / glyph.cols;
}

/// Whether the stem has a stroke at the top to the left only, as in a 1; serifs are on both sides.
bool has_flag(const cv::Mat& glyph) {
  cv::Mat mirrored;
  cv::flip(glyph, mirrored, 1);
  const auto sticks_out = [](const cv::Mat& side) {
    return (left_side(side, 0.55, 0.85) - left_side(side, 0.12, 0.28)) / side.rows;
  };
  return sticks_out(glyph) > 0.08 && sticks_out(mirrored) < 0.03;
}

/// Difference of a glyph and its mirror image / its ink, 0 … 2.
double asymmetry(const cv::Mat& glyph) {
  cv::Mat mirrored;
  cv::flip(glyph, mirrored, 1);
  return cv::norm(glyph, mirrored, cv::NORM_L1) / (1 + cv::norm(255 - glyph, cv::NORM_L1));
}

/// Whether a glyph is one straight stroke from top to bottom, without the gap of a !.
bool is_bar(const cv::Mat& glyph) {
  if (glyph.cols > kBar * glyph.rows) return false;
  cv::Mat rows;
  cv::reduce(glyph, rows, 1, cv::REDUCE_AVG, CV_32F);
  double most = 0;
  cv::minMaxLoc(rows.rowRange(glyph.rows / 10, glyph.rows - glyph.rows / 10), nullptr, &most);
  return most < 128;
}

/// The share of ink in a rectangle of a glyph, given as shares of its width and height.
double ink_in(const cv::Mat& glyph, const cv::Rect2d& part) {
  const cv::Rect box(
      cv::Point(cvRound(part.x * glyph.cols), cvRound(part.y * glyph.rows)),
      cv::Point(cvRound(part.br().x * glyph.cols), cvRound(part.br().y * glyph.rows)));
  return box.empty() ? 1 : static_cast<double>(cv::countNonZero(glyph(box) < 128)) / box.area();
}

std::string text_of(const std::vector<Letter>& letters) {
  std::string text;
  for (const auto& each : letters) {
    if (each.begins_word && !text.empty()) text += ' ';
    text += each.letter;
  }
  return text;
}

/// Approximate height of capital letters [px].
int height_of(const std::vector<cv::Rect>& boxes) {
  int height = 1;
  for (const auto& box : boxes) height = std::max(height, box.height);
  return height;
}

/// The glyph of each letter. Both are in the same order and at about the same place: dynamic
/// programming minimises the sum of the distances / height, kUnread for each glyph without a letter
/// and kShared for each letter that shares a glyph.
std::vector<std::size_t> glyphs_of(const std::vector<Letter>& letters,
                                   const std::vector<cv::Rect>& boxes) {
  const int height = height_of(boxes);
  const auto distance = [&](std::size_t letter, std::size_t glyph) {
    const int x = letters[letter].x, left = boxes[glyph].x, right = boxes[glyph].br().x;
    return static_cast<double>(std::max({left - x, x - right, 0})) / height;
  };
  // costs[i][k]: minimum for the first i + 1 letters with the last one at glyph k; from: the glyph
  // of the letter before.
  const std::size_t count = boxes.size();
  std::vector<std::vector<double>> costs(letters.size(), std::vector<double>(count));
  std::vector<std::vector<std::size_t>> from(letters.size(), std::vector<std::size_t>(count));
  for (std::size_t i = 0; i < letters.size(); ++i)
    for (std::size_t k = 0; k < count; ++k) {
      double least = i == 0 ? kUnread * static_cast<double>(k) : costs[i - 1][k] + kShared;
      from[i][k] = k;
      for (std::size_t before = 0; i > 0 && before < k; ++before) {
        const double cost = costs[i - 1][before] + kUnread * static_cast<double>(k - before - 1);
        if (cost < least) least = cost, from[i][k] = before;
      }
      costs[i][k] = least + distance(i, k);
    }
  std::vector<std::size_t> glyphs(letters.size());
  if (letters.empty()) return glyphs;
  auto& ends = costs.back();
  for (std::size_t k = 0; k < count; ++k) ends[k] += kUnread * static_cast<double>(count - 1 - k);
  glyphs.back() =
      static_cast<std::size_t>(std::min_element(ends.begin(), ends.end()) - ends.begin());
  for (std::size_t i = letters.size() - 1; i > 0; --i) glyphs[i - 1] = from[i][glyphs[i]];
  return glyphs;
}

/// The letters of a line, assigned to its glyphs.
struct Match {
  std::vector<cv::Rect> boxes;
  std::vector<Letter> letters;
  std::vector<std::size_t> glyphs;  // each letter's, in boxes
  int odd = 0;                      // letters without room, and glyphs without a letter
  int touching = 0;                 // letters that share a glyph with the one before

  [[nodiscard]] std::size_t sharing(std::size_t glyph) const {
    return static_cast<std::size_t>(std::count(glyphs.begin(), glyphs.end(), glyph));
  }
  /// By fewer odd letters, then by fewer touching ones.
  [[nodiscard]] bool is_better_than(const Match& other) const {
    return odd != other.odd ? odd < other.odd : touching < other.touching;
  }
};

/// The usual width of a letter: the median of those alone in their glyph, except bars; without any,
/// derived from the height.
double usual_width(const Match& match) {
  std::vector<int> widths;
  for (std::size_t k = 0; k < match.boxes.size(); ++k)
    if (match.sharing(k) == 1 && match.boxes[k].width > kBar * match.boxes[k].height)
      widths.push_back(match.boxes[k].width);
  if (widths.empty()) return kWidth * height_of(match.boxes);
  return median(std::move(widths));
}

/// Whether the letters [first, end) can be one glyph because they touch.
bool may_touch(const std::vector<Letter>& letters, std::size_t first, std::size_t end,
               const cv::Rect& box, double usual_width) {
  double wide = 0;
  for (std::size_t i = first; i < end; ++i)
    wide += kSlim.find(letters[i].letter) == kSlim.npos ? 1 : kSlimWidth;
  return box.width > kTouching * wide * usual_width;
}

/// Which of several letters of a glyph to drop: the less confident one of two that look alike,
/// otherwise the least confident one.
std::size_t worst_of(const std::vector<Letter>& letters, std::size_t first, std::size_t end) {
  std::size_t worst = first;
  bool is_alike = false;
  for (std::size_t i = first; i < end; ++i) {
    const bool has_alike = (i > first && are_alike(letters[i - 1].letter, letters[i].letter)) ||
                           (i + 1 < end && are_alike(letters[i].letter, letters[i + 1].letter));
    if (has_alike == is_alike ? letters[i].confidence < letters[worst].confidence : has_alike)
      worst = i;
    is_alike |= has_alike;
  }
  return worst;
}

/// Assigns letters to glyphs (ink is below `darker`) and drops letters read twice from one glyph.
Match match(const cv::Mat& line, const std::vector<Letter>& letters, int darker) {
  Match match{find_letters(line, darker), letters, {}};
  auto& [boxes, left, glyphs, odd, touching] = match;
  if (boxes.empty()) {
    odd = static_cast<int>(letters.size());
    return match;
  }
  glyphs = glyphs_of(left, boxes);
  const double usual = usual_width(match);
  std::size_t first = 0;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    std::size_t end = first + match.sharing(k);
    if (end == first) ++odd;
    while (end > first + 1 && !may_touch(left, first, end, boxes[k], usual)) {
      const std::size_t worst = worst_of(left, first, end);
      const auto at = static_cast<std::ptrdiff_t>(worst);
      if (left[worst].begins_word && worst + 1 < end) left[worst + 1].begins_word = true;
      left.erase(left.begin() + at);
      glyphs.erase(glyphs.begin() + at);
      --end;
      ++odd;
    }
    touching += std::max(0, static_cast<int>(end - first) - 1);
    first = end;
  }
  return match;
}

/// Corrects spaces by the gaps: removes those no wider than the gaps within words, and adds those
/// as wide as the gaps between words.
void set_spaces(Match& match) {
  auto& letters = match.letters;
  const auto& boxes = match.boxes;
  const auto& glyphs = match.glyphs;
  const auto gap = [&](std::size_t i) {
    return glyphs[i] == glyphs[i - 1]
               ? 1
               : std::max(1, boxes[glyphs[i]].x - boxes[glyphs[i - 1]].br().x);
  };
  std::vector<int> within;
  double space = 1e9;
  for (std::size_t i = 1; i < letters.size(); ++i)
    if (!letters[i].begins_word) within.push_back(gap(i));
  if (within.size() < 3) return;
  const int usual = median(std::move(within));
  const double least = std::max(kGap * usual, kLeastSpace * height_of(boxes));
  for (std::size_t i = 1; i < letters.size(); ++i) {
    if (gap(i) < least) letters[i].begins_word = false;
    if (letters[i].begins_word) space = std::min<double>(space, gap(i));
  }
  // Without any space read, a gap must be wider.
  const double least_new =
      space < 1e9 ? kSpace * space : std::max(kWideGap * usual, kWideSpace * height_of(boxes));
  for (std::size_t i = 1; i < letters.size(); ++i)
    if (gap(i) > least_new) letters[i].begins_word = true;
}

}  // namespace

std::vector<cv::Rect> find_letters(const cv::Mat& line, int darker) {
  cv::Mat labels, stats, middles;
  const int count = cv::connectedComponentsWithStats(line < darker, labels, stats, middles, 8);
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
  const auto holes = holes_of(glyph);
  const double middle = holes.size() == 1 ? middle_of(holes[0], glyph) : 0;
  constexpr std::string_view kRings = "0OQ9EYS56";
  const bool is_ring = holes.size() == 1 && kRings.find(letter) != kRings.npos;
  if (is_ring && middle < kUpper) return '9';
  if (is_ring && middle > 1 - kUpper) return '6';
  switch (letter) {
    case '0':
    case 'O': {
      if (holes.size() != 1) return letter;
      const double round =
          static_cast<double>(glyph.cols + holes[0].width) / (glyph.rows + holes[0].height);
      return round < kNarrow ? '0' : round > kRound ? 'O' : letter;
    }
    case '9':
    case 'Q':
      return holes.size() == 1 && middle > kMiddle ? 'Q' : letter;
    case '2':
    case 'Z': {
      const double cut = cut_corner(glyph);
      return cut > kRoundCorner ? '2' : cut < kCorner ? 'Z' : letter;
    }
    case 'G':
      return ink_in(glyph, {0.7, 0.48, 0.3, 0.14}) < kNoInk ? 'C' : letter;
    case 'E':
      if (ink_in(glyph, {0.5, 0, 0.5, 0.55}) < kNoInk) return 'L';
      [[fallthrough]];
    case 'Y':
    case '5':
    case 'S': {
      if (holes.size() == 2) return '8';
      if (letter == 'E' || letter == 'Y') return letter;
      const double is = bulge(glyph);
      if (is < kOpen) return '3';
      return is < kStraight ? '5' : is > kBulging ? 'S' : letter;
    }
    case 'I':
      return has_flag(glyph) ? '1' : letter;
    case '1':
      return is_bar(glyph) || asymmetry(glyph) < kEven ? 'I' : letter;
    case '!':
      return is_bar(glyph) ? 'I' : letter;
    default:
      return letter;
  }
}

Correction by_shape(const cv::Mat& line, const Reading& reading, bool upper_case) {
  if (reading.letters.empty()) return {reading.text, 0};
  // A lower threshold leaves less ink and separates touching letters.
  auto best = match(line, reading.letters, 128);
  for (const int darker : {96, 64, 32}) {
    if (best.odd == 0 && best.touching == 0) break;
    if (auto other = match(line, reading.letters, darker); other.is_better_than(best))
      best = std::move(other);
  }
  if (best.glyphs.empty()) return {reading.text, best.odd};
  if (best.odd == 0) set_spaces(best);
  auto& letters = best.letters;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const bool is_alone =
        letters[i].begins_word && (i + 1 == letters.size() || letters[i + 1].begins_word);
    // A word of a single upright stroke is not an l.
    if (upper_case ? !letters[i].is_known : is_alone && letters[i].letter == '1') {
      if (best.sharing(best.glyphs[i]) == 1)
        letters[i].letter = by_shape(line(best.boxes[best.glyphs[i]]), letters[i].letter);
    } else if (is_alone && letters[i].letter == 'l') {
      letters[i].letter = 'I';
    }
  }
  return {text_of(letters), best.odd};
}

}  // namespace hc::vision
