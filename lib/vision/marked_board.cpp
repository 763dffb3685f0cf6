// SPDX-License-Identifier: Apache-2.0
#include <vision/marked_board.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <vision/crossing.h>
#include <vision/image.h>
#include <vision/marker_finder.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

constexpr std::size_t kLeastMarkers = 2;  // in each image
constexpr std::size_t kLeastCorners = 8;  // of a view
constexpr double kLeastShare = 0.1;       // of the board's area

/// A corner as the markers beside it predict it.
struct Crossing {
  cv::Point2f sum;             ///< of the predicted places [px]
  float markers = 0;           ///< that predict it
  cv::Point2f across, down;    ///< to the next lines of the board [px]
  bool is_dark_along = false;  ///< the areas at across + down and opposite are black

  [[nodiscard]] cv::Point2f place() const { return sum / markers; }
};

/// The markers of a board, each seen once; one seen twice may be of another board.
std::vector<Marker> of_board(const std::vector<Marker>& seen, std::size_t count) {
  std::vector<Marker> markers;
  for (const auto& marker : seen) {
    const auto same = std::count_if(seen.begin(), seen.end(),
                                    [&](const Marker& other) { return other.id == marker.id; });
    if (same == 1 && static_cast<std::size_t>(marker.id) < count) markers.push_back(marker);
  }
  return markers;
}

/// Those that are where the layout has them, on one plane; none if too many are not.
std::vector<Marker> that_fit(const std::vector<Marker>& markers,
                             const std::vector<BoardMarker>& layout) {
  if (markers.size() < kLeastMarkers) return {};
  std::vector<cv::Point2f> from, to;
  double side = 0;
  for (const auto& marker : markers) {
    const auto& places = layout[static_cast<std::size_t>(marker.id)].corners;
    from.insert(from.end(), places.begin(), places.end());
    to.insert(to.end(), marker.corners.begin(), marker.corners.end());
    side += marker.mean_side() / static_cast<double>(markers.size());
  }
  // Lenses bend a board by less than that.
  constexpr double kReach = 0.25;  // of a marker's side
  const cv::Mat H = cv::findHomography(from, to, cv::RANSAC, kReach * side);
  if (H.empty()) return {};
  cv::perspectiveTransform(from, from, H);
  std::vector<Marker> fitting;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const auto off = [&](std::size_t k) { return cv::norm(from[4 * i + k] - to[4 * i + k]); };
    if (std::max({off(0), off(1), off(2), off(3)}) < kReach * side) fitting.push_back(markers[i]);
  }
  if (fitting.size() < kLeastMarkers || 3 * fitting.size() < 2 * markers.size()) return {};
  return fitting;
}

/// The corners beside a marker.
/// @param room  from a corner to the next line of the board [m].
void predict(const Board& board, const BoardMarker& on_board, const Marker& marker, double room,
             std::map<std::size_t, Crossing>& crossings) {
  static const std::array<cv::Point2f, 4> kOutwards = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::array<cv::Point2f, 4> seen;
  std::copy(marker.corners.begin(), marker.corners.end(), seen.begin());
  const cv::Mat H = cv::getPerspectiveTransform(on_board.corners.data(), seen.data());
  const auto outwards =
      static_cast<float>(board.kind == BoardKind::Charuco ? (board.square - board.marker) / 2 : 0);
  const auto step = static_cast<float>(room);
  for (std::size_t i = 0; i < 4; ++i) {
    if (!on_board.nearest[i]) continue;
    const cv::Point2f place = on_board.corners[i] + outwards * kOutwards[i];
    std::vector<cv::Point2f> points = {place, place + cv::Point2f(step, 0),
                                       place + cv::Point2f(0, step)};
    cv::perspectiveTransform(points, points, H);
    auto& crossing = crossings[*on_board.nearest[i]];
    crossing.sum += points[0];
    crossing.markers += 1;
    crossing.across = points[1] - points[0];
    crossing.down = points[2] - points[0];
    // A tag is black at its corners, the square around a marker white.
    crossing.is_dark_along = (board.kind == BoardKind::AprilGrid) == (i % 2 == 0);
  }
}

/// Whether two areas that meet at a place are black, the other two white, and nothing hides them.
bool is_crossing(const cv::Mat& grey, const Crossing& crossing, cv::Point2f place) {
  constexpr int kLeastContrast = 15;
  constexpr double kAlike = 0.3;  // of the contrast
  const auto [dark, light] =
      crossing.is_dark_along
          ? std::pair(crossing.across + crossing.down, crossing.across - crossing.down)
          : std::pair(crossing.across - crossing.down, crossing.across + crossing.down);
  for (const float share : {0.4F, 0.8F}) {  // of the way to the next lines
    const auto level = [&](cv::Point2f way) -> int {
      return grey.at<std::uint8_t>(cv::Point(place + share * way));
    };
    const std::array<int, 4> levels = {level(light), level(-light), level(dark), level(-dark)};
    const int contrast = (levels[0] + levels[1] - levels[2] - levels[3]) / 2;
    if (contrast < kLeastContrast || std::max(std::abs(levels[0] - levels[1]),
                                              std::abs(levels[2] - levels[3])) > kAlike * contrast)
      return false;
  }
  return true;
}

/// The refined place of a corner; nothing if it is hidden or too small.
std::optional<cv::Point2f> refined(const cv::Mat& grey, const Crossing& crossing) {
  constexpr float kLeastRoom = 1.8F;  // [px]
  const float room = room_around(crossing.across, crossing.down);
  const cv::Point2f expected = crossing.place();
  const float reach = std::abs(crossing.across.x) + std::abs(crossing.across.y) +
                      std::abs(crossing.down.x) + std::abs(crossing.down.y);
  const cv::Rect2f inside(reach, reach, static_cast<float>(grey.cols) - 2 * reach,
                          static_cast<float>(grey.rows) - 2 * reach);
  if (!(room >= kLeastRoom) || !inside.contains(expected)) return std::nullopt;
  cv::Point2f place = expected;
  refine_crossing(grey, room, place);
  const double moved = cv::norm(place - expected);
  if (moved == 0 || moved > room / 2 || !is_crossing(grey, crossing, place)) return std::nullopt;
  return place;
}

double area_of(const std::vector<cv::Point3f>& places) {
  std::vector<cv::Point2f> flat, hull;
  for (const auto& place : places) flat.emplace_back(place.x, place.y);
  cv::convexHull(flat, hull);
  return cv::contourArea(hull);
}

}  // namespace

Result<MarkedBoardFinder> MarkedBoardFinder::make(const Board& board,
                                                  const std::string& dictionary) {
  HC_TRY(board.check());
  if (board.kind == BoardKind::Chessboard) return Error{Code::Invalid, "a board without markers"};
  if (board.kind == BoardKind::AprilGrid) {
    const AprilTagFinder tags(1, true);
    return MarkedBoardFinder(board, [tags](const cv::Mat& grey) { return tags.find(grey); },
                             {layout_of(board)});
  }
  const auto markers = HC_TRY(ArucoFinder::make(dictionary));
  std::vector<Layout> layouts = {layout_of(board)};
  if (board.rows % 2 == 0) layouts.push_back(layout_of(board, true));
  HC_TRY(markers.has(layouts.front().size()));
  return MarkedBoardFinder(
      board, [markers](const cv::Mat& grey) { return markers.find(grey); }, layouts);
}

MarkedBoardFinder::Seen MarkedBoardFinder::look(const cv::Mat& image) const {
  constexpr int kSmallest = 32, kLargest = 1280;  // sides of an image that is searched [px]
  Seen seen;
  if (std::min(image.cols, image.rows) < kSmallest) return seen;
  seen.grey = grey_of(image);
  const double scale = std::min(1.0, 1.0 * kLargest / std::max(image.cols, image.rows));
  cv::Mat small = seen.grey;
  if (scale < 1) cv::resize(seen.grey, small, {}, scale, scale, cv::INTER_AREA);
  seen.markers = of_board(find_markers_(small), layouts_.front().size());
  // The centre of the top left pixel is at (0, 0) in both images.
  const cv::Point2d half(0.5, 0.5);
  for (auto& marker : seen.markers)
    for (auto& corner : marker.corners) corner = (corner + half) / scale - half;
  return seen;
}

MarkedBoardFinder::Corners MarkedBoardFinder::corners_of(const Seen& seen,
                                                         const Layout& layout) const {
  // The border of a tag is an eighth of its side, or a fifth.
  const double room = board_.kind == BoardKind::Charuco
                          ? (board_.square - board_.marker) / 2
                          : std::min(board_.spacing, 1.0 / 8) * board_.marker;
  std::map<std::size_t, Crossing> crossings;
  for (const auto& marker : seen.markers)
    predict(board_, layout[static_cast<std::size_t>(marker.id)], marker, room, crossings);
  Corners corners;
  for (const auto& [number, crossing] : crossings)
    if (const auto place = refined(seen.grey, crossing)) corners[number] = *place;
  return corners;
}

bool MarkedBoardFinder::is_enough(const BoardView& view) const {
  return view.left.size() >= kLeastCorners &&
         area_of(view.on(board_)) >= kLeastShare * area_of(board_.corners());
}

std::optional<BoardView> MarkedBoardFinder::find(const cv::Mat& left, const cv::Mat& right) const {
  Seen one = look(left);
  if (one.markers.size() < kLeastMarkers) return std::nullopt;
  Seen other = look(right);
  // Both images together, since a part of the board may fit two layouts, a square apart. Which one
  // is taken then does not matter, if it is the same in both.
  const Layout* best = nullptr;
  std::vector<Marker> best_one, best_other;
  for (const auto& layout : layouts_) {
    auto fits_one = that_fit(one.markers, layout), fits_other = that_fit(other.markers, layout);
    if (fits_one.empty() || fits_other.empty() ||
        fits_one.size() + fits_other.size() <= best_one.size() + best_other.size())
      continue;
    best = &layout;
    best_one = std::move(fits_one);
    best_other = std::move(fits_other);
  }
  if (best == nullptr) return std::nullopt;
  one.markers = std::move(best_one);
  other.markers = std::move(best_other);
  const Corners in_one = corners_of(one, *best), in_other = corners_of(other, *best);
  BoardView view;
  for (const auto& [number, place] : in_one) {
    const auto same = in_other.find(number);
    if (same == in_other.end()) continue;
    view.numbers.push_back(number);
    view.left.push_back(place);
    view.right.push_back(same->second);
  }
  if (!is_enough(view)) return std::nullopt;
  return view;
}

}  // namespace hc::vision
