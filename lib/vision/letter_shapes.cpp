// SPDX-License-Identifier: Apache-2.0
#include <vision/letter_shapes.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include <opencv2/imgproc.hpp>

namespace hc::vision {

namespace {

// As measured of Liberation Sans, Sans Narrow and Serif, DejaVu Sans and Serif, condensed and bold
// ones too, and OpenCV's four Hershey fonts with strokes of several widths, sharp and blurred.
// Width by height of the middle of the stroke: 0 up to 0.69, O from 0.73, seen from the side by
// some degrees. Between these limits it is left. An O of a typewriter's font is as narrow as a 0.
constexpr double kNarrow = 0.695, kRound = 0.72;
// How far the left side protrudes in the middle of its upper part, by the width: 5 up to 0.03, S
// from 0.07.
constexpr double kStraight = 0.045, kBulging = 0.06;
// Where the middle of the hole is, from the top: of a 9 at 0.33 at most, of a Q from 0.40.
constexpr double kUpper = 0.355, kMiddle = 0.375;
// How far the upper right corner is cut off: of a Z 0.05 at most, of a 2 from 0.14.
constexpr double kCorner = 0.08, kRoundCorner = 0.11;
constexpr double kEven = 0.14;   // what differs less from its mirror image is an I, not a 1
constexpr double kOpen = -0.2;   // what is open there is a 3
constexpr double kBar = 0.28;    // width by height of an I without serifs at most; 1 from 0.33
constexpr double kSure = 96;     // [%] what is surer was not read twice
constexpr double kGap = 1.6;     // by the median of those in words; a space is wider
constexpr double kSpace = 0.75;  // by the narrowest space that was read; a gap so wide is one

constexpr std::string_view kAlike[] = {"0OQ9", "1I!", "2Z", "35S9", "368BES", "4A", "VY"};

bool are_alike(char a, char b) {
  return a != b && std::any_of(std::begin(kAlike), std::end(kAlike), [&](auto alike) {
           return alike.find(a) != alike.npos && alike.find(b) != alike.npos;
         });
}

/// The holes of a glyph, in it [px].
std::vector<cv::Rect> holes_of(const cv::Mat& glyph) {
  cv::Mat ground, labels, stats, middles;
  cv::copyMakeBorder(glyph >= 128, ground, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  const int count = cv::connectedComponentsWithStats(ground, labels, stats, middles, 4);
  // The holes are what is not connected with the ground outside; specks are none.
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

/// Where the middle of a hole is, from the top, by the glyph's height.
double middle_of(const cv::Rect& hole, const cv::Mat& glyph) {
  return (hole.y + hole.height / 2.0) / glyph.rows;
}

/// Where the ink begins, from the left, in rows given as parts of the height: the median [px].
double left_side(const cv::Mat& glyph, double from, double to) {
  const int first = cvRound(from * glyph.rows);
  const int last = std::min(glyph.rows, std::max(first + 1, cvRound(to * glyph.rows)));
  std::vector<double> sides;
  for (int y = first; y < last; ++y) {
    const auto* row = glyph.ptr<std::uint8_t>(y);
    int x = 0;
    while (x < glyph.cols && row[x] >= 128) ++x;
    // Between the pixels; what is beyond the box is white.
    const double before = x == 0 ? 255 : row[x - 1];
    sides.push_back(x == glyph.cols ? x : x - (128 - row[x]) / std::max(1.0, before - row[x]));
  }
  const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
  std::nth_element(sides.begin(), middle, sides.end());
  return *middle;
}

/// How far an S or 5 protrudes to the left between the top and the middle, by its width.
double bulge(const cv::Mat& glyph) {
  const double ends = (left_side(glyph, 0.02, 0.12) + left_side(glyph, 0.3, 0.4)) / 2;
  return 2 * (ends - left_side(glyph, 0.14, 0.26)) / glyph.cols;
}

/// How far the upper right corner of a 2 or Z is cut off, by the width.
double cut_corner(const cv::Mat& glyph) {
  cv::Mat mirrored;
  cv::flip(glyph, mirrored, 1);
  return left_side(mirrored, 0, 0.08) / glyph.cols;
}

/// Whether a stroke sticks out to the left of the stem at the top and none to the right, as of a 1;
/// serifs stick out to both.
bool has_flag(const cv::Mat& glyph) {
  cv::Mat mirrored;
  cv::flip(glyph, mirrored, 1);
  const auto sticks_out = [](const cv::Mat& side) {
    return (left_side(side, 0.55, 0.85) - left_side(side, 0.12, 0.28)) / side.rows;
  };
  return sticks_out(glyph) > 0.08 && sticks_out(mirrored) < 0.03;
}

/// How much a glyph differs from its mirror image, by its ink: nothing to twice all.
double asymmetry(const cv::Mat& glyph) {
  cv::Mat mirrored;
  cv::flip(glyph, mirrored, 1);
  return cv::norm(glyph, mirrored, cv::NORM_L1) / (1 + cv::norm(255 - glyph, cv::NORM_L1));
}

/// Whether a glyph is one straight stroke from top to bottom, where a ! has a gap above its dot.
bool is_bar(const cv::Mat& glyph) {
  if (glyph.cols > kBar * glyph.rows) return false;
  cv::Mat rows;
  cv::reduce(glyph, rows, 1, cv::REDUCE_AVG, CV_32F);
  double most = 0;
  cv::minMaxLoc(rows.rowRange(glyph.rows / 10, glyph.rows - glyph.rows / 10), nullptr, &most);
  return most < 128;
}

/// Drops letters that were read twice until there are as many as glyphs, if possible.
void drop_twice(std::vector<Letter>& letters, std::size_t glyphs) {
  while (letters.size() > glyphs) {
    auto worst = letters.end();
    for (auto next = letters.begin(); next != letters.end() && next + 1 != letters.end(); ++next) {
      if (!are_alike(next->letter, next[1].letter) || next[1].begins_word) continue;
      const auto less = next[1].confidence < next->confidence ? next + 1 : next;
      if (less->confidence >= kSure) continue;
      if (worst == letters.end() || less->confidence < worst->confidence) worst = less;
    }
    if (worst == letters.end()) return;
    if (worst->begins_word) worst[1].begins_word = true;
    letters.erase(worst);
  }
}

std::string text_of(const std::vector<Letter>& letters) {
  std::string text;
  for (const auto& each : letters) {
    if (each.begins_word && !text.empty()) text += ' ';
    text += each.letter;
  }
  return text;
}

/// Sets spaces by the gaps: none where it is no wider than those within words, and one where it is
/// as wide as the others between words.
void set_spaces(std::vector<Letter>& letters, const std::vector<cv::Rect>& boxes) {
  const auto gap = [&](std::size_t i) { return std::max(1, boxes[i].x - boxes[i - 1].br().x); };
  std::vector<int> within;
  double space = 1e9;
  for (std::size_t i = 1; i < letters.size(); ++i)
    if (!letters[i].begins_word) within.push_back(gap(i));
  if (within.size() < 3) return;
  const auto middle = within.begin() + static_cast<std::ptrdiff_t>(within.size() / 2);
  std::nth_element(within.begin(), middle, within.end());
  for (std::size_t i = 1; i < letters.size(); ++i) {
    if (gap(i) < kGap * *middle) letters[i].begins_word = false;
    if (letters[i].begins_word) space = std::min<double>(space, gap(i));
  }
  for (std::size_t i = 1; i < letters.size(); ++i)
    if (gap(i) > kSpace * space) letters[i].begins_word = true;
}

/// Whether boxes are of the letters, one by one, and not as many by chance.
bool are_of(const std::vector<cv::Rect>& boxes, const std::vector<Letter>& letters) {
  if (boxes.size() != letters.size()) return false;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (letters[i].x < boxes[i].x || letters[i].x > boxes[i].br().x) return false;
  return true;
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
    case 'E':
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

std::string by_shape(const cv::Mat& line, const Reading& reading, bool upper_case) {
  auto letters = reading.letters;
  // What is darker is ink; less of it where letters touch.
  std::vector<cv::Rect> boxes;
  for (const int darker : {128, 96, 64, 32}) {
    boxes = find_letters(line, darker);
    if (boxes.size() >= letters.size()) break;
  }
  if (boxes.size() < letters.size()) {
    boxes = find_letters(line);
    drop_twice(letters, boxes.size());
  }
  if (letters.size() != boxes.size()) return reading.text;
  if (are_of(boxes, letters)) set_spaces(letters, boxes);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const bool is_alone =
        letters[i].begins_word && (i + 1 == letters.size() || letters[i + 1].begins_word);
    // A word of nothing but an upright stroke is no l.
    if (upper_case ? !letters[i].is_known : is_alone && letters[i].letter == '1')
      letters[i].letter = by_shape(line(boxes[i]), letters[i].letter);
    else if (is_alone && letters[i].letter == 'l')
      letters[i].letter = 'I';
  }
  return text_of(letters);
}

}  // namespace hc::vision
