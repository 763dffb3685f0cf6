// SPDX-License-Identifier: Apache-2.0
#include <vision/letters.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include <hc/base/median.h>

namespace hc::vision {
namespace {

// Of letters, in pixels of the searched pyramid level.
constexpr int kLeastHeight = 8, kMostHeight = 40, kWindow = 35;
constexpr int kMostPieces = 1500;  // limits the cost of grainy images
constexpr int kLevels = 3;
// Lines of at least this slope, score and number of letters are searched again after levelling, at
// most kMostTurned of them.
constexpr double kTurned = 0.08, kTurnedScore = 0.2;
constexpr int kTurnedLetters = 4;
constexpr std::size_t kMostTurned = 3;

/// A connected dark region.
struct Piece {
  cv::Rect box;
  double ink = 0, ground = 0;  // mean grey inside and around it
  bool is_letter = false;      // by its size; otherwise perhaps punctuation
  bool is_bar = false;         // full of ink, such as an I or the gap beside a book
  [[nodiscard]] float left() const { return static_cast<float>(box.x); }
  [[nodiscard]] float right() const { return static_cast<float>(box.x + box.width); }
  [[nodiscard]] float top() const { return static_cast<float>(box.y); }
  [[nodiscard]] float bottom() const { return static_cast<float>(box.y + box.height); }
  [[nodiscard]] float middle_x() const { return (left() + right()) / 2; }
  [[nodiscard]] float middle_y() const { return (top() + bottom()) / 2; }
  [[nodiscard]] float height() const { return static_cast<float>(box.height); }
};

/// y = slope · x + offset
struct Slant {
  double slope = 0, offset = 0;
  [[nodiscard]] double at(double x) const { return slope * x + offset; }
};

/// Measures a piece inside and around its box; nothing if it is too faint for a letter.
std::optional<Piece> look_at(const cv::Mat& grey, const cv::Mat& labels, const cv::Mat& dark,
                             int label, const cv::Rect& box, double min_contrast) {
  const cv::Rect around =
      cv::Rect(box.x - 2, box.y - 2, box.width + 4, box.height + 4) & cv::Rect({}, grey.size());
  double ink = 0, ground = 0;
  int inks = 0, grounds = 0;
  for (int y = around.y; y < around.br().y; ++y) {
    const auto* value = grey.ptr<std::uint8_t>(y);
    const auto* name = labels.ptr<std::int32_t>(y);
    const auto* is_dark = dark.ptr<std::uint8_t>(y);
    for (int x = around.x; x < around.br().x; ++x) {
      if (name[x] == label) ink += value[x], ++inks;
      if (is_dark[x] == 0) ground += value[x], ++grounds;
    }
  }
  if (inks == 0 || grounds == 0) return {};
  Piece piece{box, ink / inks, ground / grounds};
  if (piece.ground - piece.ink < min_contrast) return {};
  return piece;
}

/// The dark pieces of an image that may be letters or punctuation.
std::vector<Piece> find_pieces(const cv::Mat& grey, double noise, cv::Mat& dark) {
  const double least = std::max(6.0, 3 * noise);
  cv::adaptiveThreshold(grey, dark, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, kWindow,
                        least);
  cv::Mat labels, stats, middles;
  const int count = cv::connectedComponentsWithStats(dark, labels, stats, middles, 8);
  std::vector<Piece> pieces;
  for (int label = 1; label < count && pieces.size() < kMostPieces; ++label) {
    const int* of = stats.ptr<int>(label);
    const cv::Rect box(of[cv::CC_STAT_LEFT], of[cv::CC_STAT_TOP], of[cv::CC_STAT_WIDTH],
                       of[cv::CC_STAT_HEIGHT]);
    const int area = of[cv::CC_STAT_AREA];
    if (box.height > kMostHeight || box.width > 6 * kMostHeight || area < 4) continue;
    const double filled = static_cast<double>(area) / box.area();
    const bool is_solid = filled > 0.85 && 10 * box.width > 6 * box.height;
    const bool is_letter = box.height >= kLeastHeight && box.width <= 6 * box.height &&
                           filled > 0.12 && area >= 10 && !is_solid;
    // Specks of noise are smaller than the full stops of the smallest letters.
    if (!is_letter && (box.height > kMostHeight / 2 || box.width > kMostHeight)) continue;
    auto piece = look_at(grey, labels, dark, label, box, 2 * least);
    if (!piece) continue;
    piece->is_letter = is_letter;
    piece->is_bar = filled > 0.85;
    pieces.push_back(*piece);
  }
  return pieces;
}

/// Whether two letters may be neighbours in a line.
bool are_neighbours(const Piece& a, const Piece& b) {
  const float high = std::max(a.height(), b.height()), low = std::min(a.height(), b.height());
  if (high > 1.8F * low) return false;
  // An inclined line rises more between distant letters.
  const float apart = std::abs(a.middle_x() - b.middle_x());
  if (std::abs(a.middle_y() - b.middle_y()) > 0.35F * high + 0.15F * apart) return false;
  const float gap = std::max(a.left(), b.left()) - std::min(a.right(), b.right());
  if (gap > 2.0F * high || gap < -0.3F * high) return false;
  const double contrast = std::max(a.ground - a.ink, b.ground - b.ink);
  return std::abs(a.ground - b.ground) < 0.35 * contrast &&
         std::abs(a.ink - b.ink) < 0.5 * contrast;
}

/// Whether something dark, such as the frame of a board, separates two columns.
bool is_parted(const cv::Mat& dark, double left, double right, double top, double bottom) {
  const cv::Rect gap =
      cv::Rect(cv::Point(cvRound(left), cvRound(top)), cv::Point(cvRound(right), cvRound(bottom))) &
      cv::Rect({}, dark.size());
  if (left >= right || top >= bottom || gap.empty()) return false;
  cv::Mat rows;
  cv::reduce(dark(gap), rows, 1, cv::REDUCE_MAX);
  return cv::countNonZero(rows) == gap.height;
}

bool is_parted(const cv::Mat& dark, const Piece& a, const Piece& b) {
  return is_parted(dark, std::min(a.right(), b.right()), std::max(a.left(), b.left()),
                   std::max(a.top(), b.top()), std::min(a.bottom(), b.bottom()));
}

/// Groups letters into lines.
std::vector<std::vector<Piece>> group(const std::vector<Piece>& pieces, const cv::Mat& dark) {
  std::vector<Piece> letters;
  for (const auto& piece : pieces)
    if (piece.is_letter) letters.push_back(piece);
  std::sort(letters.begin(), letters.end(),
            [](const auto& a, const auto& b) { return a.left() < b.left(); });
  std::vector<std::size_t> group_of(letters.size());
  std::iota(group_of.begin(), group_of.end(), 0U);
  auto root = [&](std::size_t i) {
    while (group_of[i] != i) i = group_of[i] = group_of[group_of[i]];
    return i;
  };
  for (std::size_t i = 0; i < letters.size(); ++i)
    for (std::size_t k = i + 1; k < letters.size(); ++k) {
      if (letters[k].left() > letters[i].right() + 2.0F * kMostHeight) break;
      if (are_neighbours(letters[i], letters[k]) && !is_parted(dark, letters[i], letters[k]))
        group_of[root(k)] = root(i);
    }
  std::vector<std::vector<Piece>> groups(letters.size());
  for (std::size_t i = 0; i < letters.size(); ++i) groups[root(i)].push_back(letters[i]);
  std::erase_if(groups, [](const auto& each) { return each.size() < 2; });
  return groups;
}

/// The median slope of pairs of points (Theil-Sen).
double slope_of(const std::vector<cv::Point2d>& points) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = i + 1; k < points.size(); ++k)
      if (points[k].x - points[i].x > 1)
        slopes.push_back((points[k].y - points[i].y) / (points[k].x - points[i].x));
  return slopes.empty() ? 0 : median(std::move(slopes));
}

Slant slant_of(const std::vector<cv::Point2d>& points, double slope) {
  std::vector<double> offsets;
  offsets.reserve(points.size());
  for (const auto& point : points) offsets.push_back(point.y - slope * point.x);
  return {slope, median(std::move(offsets))};
}

/// Mean distance of points from a line [px].
double spread_of(const std::vector<cv::Point2d>& points, const Slant& line) {
  double sum = 0;
  for (const auto& point : points) sum += std::abs(point.y - line.at(point.x));
  return sum / static_cast<double>(points.size());
}

/// A line of letters between its top and its base line.
struct Outline {
  Slant top, base;
  double left = 1e9, right = -1e9, height = 0;
  double ink = 0, ground = 0;  // median grey
};

/// Slopes of the top and the base line.
std::pair<double, double> slopes_of(const std::vector<cv::Point2d>& tops,
                                    const std::vector<cv::Point2d>& bottoms, double height) {
  const double top = slope_of(tops), base = slope_of(bottoms);
  // Few letters do not determine the perspective, nor do tops of mixed small and capital letters.
  if (tops.size() < 5) return {(top + base) / 2, (top + base) / 2};
  const bool is_mixed = spread_of(tops, slant_of(tops, top)) > 0.08 * height;
  return {is_mixed ? base : top, base};
}

/// Nothing if they are not a line of letters.
std::optional<Outline> outline_of(const std::vector<Piece>& letters) {
  // Slots, books and stripes form rows of bars; few letters are bars.
  const auto bars = std::count_if(letters.begin(), letters.end(),
                                  [](const auto& letter) { return letter.is_bar; });
  if (4 * static_cast<std::size_t>(bars) > 3 * letters.size()) return {};
  std::vector<double> heights;
  heights.reserve(letters.size());
  for (const auto& letter : letters) heights.push_back(letter.height());
  const double usual = median(heights);
  Outline line;
  std::vector<cv::Point2d> tops, bottoms;
  std::vector<double> inks, grounds;
  for (const auto& letter : letters) {
    line.left = std::min<double>(line.left, letter.left());
    line.right = std::max<double>(line.right, letter.right());
    if (letter.height() < 0.75 * usual) continue;
    tops.emplace_back(letter.middle_x(), letter.top());
    bottoms.emplace_back(letter.middle_x(), letter.bottom());
    inks.push_back(letter.ink);
    grounds.push_back(letter.ground);
  }
  const auto [top_slope, base_slope] = slopes_of(tops, bottoms, usual);
  if (std::max(std::abs(top_slope), std::abs(base_slope)) > 0.36) return {};
  line.top = slant_of(tops, top_slope);
  line.base = slant_of(bottoms, base_slope);
  const double middle_x = (line.left + line.right) / 2;
  line.height = line.base.at(middle_x) - line.top.at(middle_x);
  if (line.height < kLeastHeight - 1) return {};
  line.ink = median(inks);
  line.ground = median(grounds);
  return line;
}

/// Mean distance of letters from the base line or the top line, to which they are aligned [px].
double unevenness_of(const std::vector<Piece>& letters, const Outline& line) {
  double sum = 0;
  for (const auto& letter : letters)
    sum += std::min(std::abs(letter.bottom() - line.base.at(letter.middle_x())),
                    std::abs(letter.top() - line.top.at(letter.middle_x())));
  return sum / static_cast<double>(letters.size());
}

/// Extends a line by the punctuation beyond its letters.
void reach_for_stops(const std::vector<Piece>& pieces, const cv::Mat& dark, Outline& line) {
  bool any = true;
  while (any) {
    any = false;
    for (const auto& piece : pieces) {
      const double x = piece.middle_x(), height = line.height;
      const double top = line.top.at(x), base = line.base.at(x);
      if (piece.top() < top - 0.15 * height || piece.bottom() > base + 0.4 * height) continue;
      if (std::abs(piece.ground - line.ground) > 0.25 * line.ground) continue;
      if (piece.box.area() < 0.008 * height * height) continue;
      if (piece.left() < line.left && piece.right() > line.left - 0.9 * height &&
          !is_parted(dark, piece.right(), line.left, top, base))
        line.left = piece.left(), any = true;
      if (piece.right() > line.right && piece.left() < line.right + 0.9 * height &&
          !is_parted(dark, line.right, piece.left(), top, base))
        line.right = piece.right(), any = true;
    }
  }
}

/// Mean and standard deviation of the ground between a line's letters.
std::pair<double, double> ground_of(const cv::Mat& grey, const cv::Mat& dark, const cv::Rect& box) {
  cv::Mat ink, mean, deviation;
  // Exclude the soft edges of letters.
  cv::dilate(dark(box), ink, cv::Mat());
  cv::meanStdDev(grey(box), mean, deviation, ink == 0);
  return {mean.at<double>(0), deviation.at<double>(0)};
}

/// The corners of a line, clockwise from the top left.
std::array<cv::Point2f, 4> corners_of(const Outline& line) {
  auto corner = [](double x, double y) {
    // Pixels are squares around their middles.
    return cv::Point2f(static_cast<float>(x - 0.5), static_cast<float>(y - 0.5));
  };
  return {corner(line.left, line.top.at(line.left)), corner(line.right, line.top.at(line.right)),
          corner(line.right, line.base.at(line.right)), corner(line.left, line.base.at(line.left))};
}

std::optional<TextLine> line_of(const std::vector<Piece>& letters, const std::vector<Piece>& pieces,
                                const cv::Mat& grey, const cv::Mat& dark, double noise) {
  auto outline = outline_of(letters);
  if (!outline) return {};
  reach_for_stops(pieces, dark, *outline);
  TextLine line;
  line.corners = corners_of(*outline);
  line.height = outline->height;
  // Touching letters are one wide piece.
  for (const auto& letter : letters)
    line.letters += std::max(1, static_cast<int>(letter.box.width / line.height));
  // A margin of a third of the height must be clean too.
  const int margin = static_cast<int>(line.height / 3);
  cv::Rect box =
      cv::boundingRect(std::vector<cv::Point2f>(line.corners.begin(), line.corners.end()));
  box = cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin);
  line.is_whole = (box & cv::Rect({}, grey.size())) == box;
  box &= cv::Rect({}, grey.size());
  if (box.empty()) return {};
  const auto [mean, deviation] = ground_of(grey, dark, box);
  const double contrast = std::max(1.0, outline->ground - outline->ink);
  const double rough = std::max(0.0, deviation - noise) / contrast;
  const double uneven = unevenness_of(letters, *outline) / line.height;
  line.score = contrast / (contrast + 20) * std::exp(-5 * rough) * std::exp(-5 * uneven) *
               (1 - std::exp(-line.letters / 3.5));
  return line;
}

/// Whether one line is directly above or below another, as on the same board.
bool are_above_each_other(const TextLine& a, const TextLine& b) {
  const auto [low, high] = std::minmax(a.height, b.height);
  const cv::Rect2f one = a.box(), other = b.box();
  const float gap = std::max(one.y, other.y) - std::min(one.br().y, other.br().y);
  const float shared = std::min(one.br().x, other.br().x) - std::max(one.x, other.x);
  return a.is_bright == b.is_bright && high < 1.8 * low && gap < 2 * high && shared > 0;
}

void scale(TextLine& line, double by) {
  // The first pixels of the two images have different centres.
  for (auto& corner : line.corners)
    corner = (corner + cv::Point2f(0.5F, 0.5F)) * by - cv::Point2f(0.5F, 0.5F);
  line.height *= by;
}

/// The approximately level lines of letters, from large to small.
std::vector<TextLine> search(cv::Mat grey, double noise, double min_score) {
  std::vector<TextLine> found;
  double by = 1;
  for (int level = 0; level < kLevels; ++level) {
    if (level > 0) {
      cv::Mat half;
      cv::resize(grey, half, {}, 0.5, 0.5, cv::INTER_AREA);
      grey = half;
      by *= 2;
      noise /= 2;
    }
    if (std::min(grey.rows, grey.cols) < 2 * kLeastHeight) break;
    for (const bool is_bright : {false, true}) {
      const cv::Mat seen = is_bright ? cv::Mat(255 - grey) : grey;
      cv::Mat dark;
      const auto pieces = find_pieces(seen, noise, dark);
      for (const auto& letters : group(pieces, dark))
        if (auto line = line_of(letters, pieces, seen, dark, noise);
            line && line->score >= min_score) {
          line->is_bright = is_bright;
          scale(*line, by);
          found.push_back(*line);
        }
    }
  }
  return found;
}

bool overlap(const TextLine& a, const TextLine& b) {
  if ((a.box() & b.box()).empty()) return false;
  cv::Mat shared;
  return cv::intersectConvexConvex(a.corners, b.corners, shared) > 0;
}

/// Sorts lines, best first, and drops those that overlap a better one.
std::vector<TextLine> best_of(std::vector<TextLine> lines) {
  std::stable_sort(lines.begin(), lines.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<TextLine> kept;
  for (const auto& line : lines)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const auto& better) { return overlap(line, better); }))
      kept.push_back(line);
  return kept;
}

/// Lines, or parts of lines, too inclined for the boxes of their letters to be reliable; none if a
/// level line is better.
std::vector<TextLine> turned_of(const std::vector<TextLine>& lines, double min_score) {
  auto best = best_of(lines);
  const auto is_level = [](const auto& line) { return std::abs(std::tan(line.angle())) < kTurned; };
  if (!best.empty() && best.front().score >= min_score && is_level(best.front())) return {};
  std::erase_if(best,
                [&](const auto& line) { return is_level(line) || line.letters < kTurnedLetters; });
  if (best.size() > kMostTurned) best.resize(kMostTurned);
  return best;
}

/// Searches again around a line after levelling it.
void search_turned(const cv::Mat& grey, double noise, const TextLine& line, double min_score,
                   std::vector<TextLine>& found) {
  const double width = line.width(), height = line.height;
  const cv::Size size(cvRound(2 * width + 12 * height), cvRound(width + 12 * height));
  const cv::Point2f middle = line.middle();
  cv::Mat turn = cv::getRotationMatrix2D(middle, line.angle() * 180 / CV_PI, 1), level, back;
  turn.at<double>(0, 2) += size.width / 2.0 - static_cast<double>(middle.x);
  turn.at<double>(1, 2) += size.height / 2.0 - static_cast<double>(middle.y);
  cv::warpAffine(grey, level, turn, size, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::invertAffineTransform(turn, back);
  const cv::Rect2f whole({}, cv::Size2f(grey.size()));
  for (auto each : search(level, noise, min_score)) {
    std::vector<cv::Point2f> corners(each.corners.begin(), each.corners.end());
    cv::transform(corners, corners, back);
    std::copy(corners.begin(), corners.end(), each.corners.begin());
    if (!whole.contains(each.middle())) continue;
    const auto margin = static_cast<float>(each.height / 3);
    auto box = each.box();
    box = {box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin};
    each.is_whole = (box & whole) == box;
    found.push_back(each);
  }
}

}  // namespace

cv::Point2f TextLine::middle() const {
  return (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
}

cv::Rect2f TextLine::box() const {
  const float left = std::min(corners[0].x, corners[3].x);
  const float right = std::max(corners[1].x, corners[2].x);
  const float top = std::min(corners[0].y, corners[1].y);
  const float bottom = std::max(corners[2].y, corners[3].y);
  return {left, top, right - left, bottom - top};
}

double TextLine::width() const {
  return cv::norm((corners[1] + corners[2]) - (corners[0] + corners[3])) / 2;
}

double TextLine::angle() const {
  const auto along = corners[1] + corners[2] - corners[0] - corners[3];
  return std::atan2(along.y, along.x);
}

std::vector<TextLine> find_text_lines(const cv::Mat& image, double min_score) {
  cv::Mat grey = mean_of_channels(image);
  double noise = noise_of(grey);
  if (noise > 4) {
    cv::Mat smooth;
    cv::GaussianBlur(grey, smooth, {}, 0.8);
    grey = smooth;
    noise *= 0.36;  // norm of the blur's kernel
  }
  std::vector<TextLine> found = search(grey, noise, std::min(min_score, kTurnedScore));
  const auto turned = turned_of(found, min_score);
  std::erase_if(found, [&](const auto& line) { return line.score < min_score; });
  for (const auto& line : turned) search_turned(grey, noise, line, min_score, found);
  return best_of(found);
}

std::vector<TextLine> block_of_best(const std::vector<TextLine>& lines) {
  std::vector<TextLine> block;
  std::vector<bool> is_taken(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_next =
        !is_taken[i] && (block.empty() || std::any_of(block.begin(), block.end(), [&](auto& each) {
                           return are_above_each_other(lines[i], each);
                         }));
    if (!is_next) continue;
    block.push_back(lines[i]);
    is_taken[i] = true;
    i = 0;  // start over: a skipped line may be next to the one just added
  }
  if (block.empty()) return block;
  const double angle = block.front().angle();
  auto down = [&](const TextLine& line) {
    return line.middle().y * std::cos(angle) - line.middle().x * std::sin(angle);
  };
  std::sort(block.begin(), block.end(),
            [&](const auto& a, const auto& b) { return down(a) < down(b); });
  return block;
}

bool is_whole(const std::vector<TextLine>& block) {
  return std::all_of(block.begin(), block.end(), [](const auto& line) { return line.is_whole; });
}

cv::Rect2f box_of(const std::vector<TextLine>& block) {
  cv::Rect2f box = block.front().box();
  for (const auto& line : block) box |= line.box();
  return box;
}

}  // namespace hc::vision
