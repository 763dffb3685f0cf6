// SPDX-License-Identifier: Apache-2.0
#include <vision/marker.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

/// The interpolated grey level; outside the image that of the border.
double level(const cv::Mat& grey, double x, double y) {
  x = std::clamp(x, 0.0, grey.cols - 1.001);
  y = std::clamp(y, 0.0, grey.rows - 1.001);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const double right_share = x - left, bottom_share = y - top;
  const auto* above = grey.ptr<std::uint8_t>(top) + left;
  const auto* below = grey.ptr<std::uint8_t>(top + 1) + left;
  return (1 - bottom_share) * ((1 - right_share) * above[0] + right_share * above[1]) +
         bottom_share * ((1 - right_share) * below[0] + right_share * below[1]);
}

struct Line {
  cv::Point2d at, along;
};

/// Rays across a side, on which its edge is searched.
class Rays {
 public:
  /// @param farthest  from the side [px].
  Rays(const cv::Mat& grey, cv::Point2d from, cv::Point2d to, double farthest)
      : grey_(grey), from_(from), side_(to - from), length_(cv::norm(side_)) {
    // Short of anything drawn beside the rim.
    const double reach = std::clamp(0.15 * length_, 1.5, farthest);
    steps_ = static_cast<std::ptrdiff_t>(std::ceil(reach / kStep));
    slopes_.resize(static_cast<std::size_t>(2 * steps_ + 1));
  }

  [[nodiscard]] cv::Point2d along() const { return side_ / length_; }
  [[nodiscard]] cv::Point2d across() const { return {-along().y, along().x}; }

  /// Points of the edge: positions along the side and across it [px].
  std::vector<std::pair<double, double>> find_edge() {
    const int rays = std::clamp(static_cast<int>(length_ / 2), 6, 40);
    // Edges are rounded near the corners.
    const auto share = [rays](int ray) { return 0.12 + 0.76 * (ray + 0.5) / rays; };
    double direction = 0;  // of all slopes: the rim is darker or lighter everywhere
    for (int ray = 0; ray < rays; ++ray) {
      measure(share(ray));
      const auto [least, most] = std::minmax_element(slopes_.begin(), slopes_.end());
      direction += *most > -*least ? *most : *least;
    }
    std::vector<std::pair<double, double>> found;
    for (int ray = 0; ray < rays; ++ray) {
      measure(share(ray));
      for (auto& slope : slopes_) slope *= direction > 0 ? 1 : -1;
      if (const auto at = peak()) found.emplace_back(share(ray) * length_, *at);
    }
    return found;
  }

 private:
  static constexpr double kStep = 0.5;  // along a ray [px]

  /// The slopes along the ray at a share of the side.
  void measure(double share) {
    const cv::Point2d middle = from_ + share * side_, over = across();
    for (auto i = -steps_; i <= steps_; ++i) {
      const cv::Point2d out = middle + (static_cast<double>(i) * kStep + 1) * over,
                        in = out - 2 * over;
      slopes_[static_cast<std::size_t>(i + steps_)] =
          level(grey_, out.x, out.y) - level(grey_, in.x, in.y);
    }
  }

  /// Where the ray is steepest, across the side [px]; nothing if it is not steep.
  [[nodiscard]] std::optional<double> peak() const {
    const auto best = std::max_element(slopes_.begin(), slopes_.end());
    constexpr double kLeastSlope = 8;  // grey levels over two pixels
    if (best == slopes_.begin() || best == slopes_.end() - 1 || *best < kLeastSlope) return {};
    // The centroid of the peak, which is less sensitive to noise than its maximum.
    const double half = *best / 2;
    double sum = 0, moment = 0;
    const auto add = [&](auto each) {
      sum += *each - half;
      moment += (*each - half) * static_cast<double>(each - slopes_.begin());
    };
    for (auto each = best; *each > half; --each) {
      add(each);
      if (each == slopes_.begin()) break;
    }
    for (auto each = best + 1; each != slopes_.end() && *each > half; ++each) add(each);
    return (moment / sum - static_cast<double>(steps_)) * kStep;
  }

  const cv::Mat& grey_;
  const cv::Point2d from_, side_;
  const double length_;
  std::ptrdiff_t steps_ = 0;    // of a ray to either side
  std::vector<double> slopes_;  // of one ray
};

/// y = slope · x + offset
struct Fit {
  double slope = 0, offset = 0;
};

/// A line fitted with Huber weights; distant points are of another edge.
std::optional<Fit> fit_line(const std::vector<std::pair<double, double>>& points) {
  Fit line;
  for (int iteration = 0; iteration < 5; ++iteration) {
    double w = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& [s, d] : points) {
      const double off = std::abs(d - line.offset - line.slope * s);
      const double weight = iteration == 0 ? 1 : 1 / std::max(0.15, off);
      w += weight;
      x += weight * s;
      y += weight * d;
      xx += weight * s * s;
      xy += weight * s * d;
    }
    const double scatter = xx * w - x * x;
    if (!(scatter > 0)) return std::nullopt;
    line.slope = (xy * w - x * y) / scatter;
    line.offset = (y - line.slope * x) / w;
  }
  return line;
}

/// The edge near a side: a line through the steepest points of rays across it.
std::optional<Line> edge_near(const cv::Mat& grey, cv::Point2d from, cv::Point2d to,
                              double farthest) {
  Rays rays(grey, from, to, farthest);
  const auto points = rays.find_edge();
  if (points.size() < 4) return std::nullopt;
  const auto line = fit_line(points);
  if (!line) return std::nullopt;
  return Line{from + line->offset * rays.across(), rays.along() + line->slope * rays.across()};
}

std::optional<cv::Point2d> meet(const Line& a, const Line& b) {
  const double turned = a.along.cross(b.along);
  if (std::abs(turned) < 1e-6) return std::nullopt;
  return a.at + (b.at - a.at).cross(b.along) / turned * a.along;
}

}  // namespace

double Marker::mean_side() const {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += cv::norm(corners[i] - corners[(i + 1) % 4]);
  return sum / 4;
}

cv::Point2d Marker::middle() const {
  return (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
}

bool refine_corners(const cv::Mat& grey, std::array<cv::Point2d, 4>& corners, double reach) {
  std::array<Line, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    auto edge = edge_near(grey, corners[i], corners[(i + 1) % 4], reach);
    if (!edge) return false;
    sides[i] = *edge;
  }
  auto refined = corners;
  for (std::size_t i = 0; i < 4; ++i) {
    auto corner = meet(sides[(i + 3) % 4], sides[i]);
    // Farther away it is another corner.
    if (!corner || cv::norm(*corner - corners[i]) > 2 * reach) return false;
    refined[i] = *corner;
  }
  corners = refined;
  return true;
}

namespace {

/// Sets the ambiguity of the best of several poses of a marker.
void set_ambiguity(MarkerPose& best, const std::vector<MarkerPose>& found) {
  constexpr double kNoise = 0.15;            // RMS of corners [px]
  constexpr double kSame = 3 * CV_PI / 180;  // rotations of one solution [rad]
  for (const auto& other : found) {
    const double angle =
        std::acos(std::clamp((cv::trace(best.R.t() * other.R) - 1) / 2, -1.0, 1.0));
    if (other.error < best.error + kNoise && angle > kSame)
      best.ambiguity = std::max(best.ambiguity, angle);
  }
}

}  // namespace

std::optional<MarkerPose> pose_of(const Marker& marker, double side, const Camera& camera) {
  const auto& p = camera.pinhole;
  const cv::Matx33d M(p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1);
  const double half = side / 2;
  // OpenCV's order and frame: y up, z out of the marker.
  const std::vector<cv::Point3d> square = {
      {-half, half, 0}, {half, half, 0}, {half, -half, 0}, {-half, -half, 0}};
  const std::vector<cv::Point2d> seen(marker.corners.begin(), marker.corners.end());
  std::vector<cv::Mat> turns, shifts;
  try {
    cv::solvePnPGeneric(square, seen, M, camera.distortion, turns, shifts, false,
                        cv::SOLVEPNP_IPPE_SQUARE);
    // OpenCV's IPPE fails on a square that faces the camera: add a third candidate.
    cv::Mat turn, shift;
    if (cv::solvePnP(square, seen, M, camera.distortion, turn, shift, false,
                     cv::SOLVEPNP_ITERATIVE)) {
      turns.push_back(turn);
      shifts.push_back(shift);
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  std::vector<MarkerPose> found;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    cv::Mat turn = turns[i], shift = shifts[i];
    if (!cv::checkRange(turn) || !cv::checkRange(shift) || shift.at<double>(2) <= 0) continue;
    cv::solvePnPRefineLM(square, seen, M, camera.distortion, turn, shift);
    std::vector<cv::Point2d> projected;
    cv::projectPoints(square, turn, shift, M, camera.distortion, projected);
    double squares = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const cv::Point2d off = projected[k] - seen[k];
      squares += off.dot(off);
    }
    const double error = std::sqrt(squares / 4);
    if (!std::isfinite(error) || shift.at<double>(2) <= 0) continue;
    cv::Matx33d R;
    cv::Rodrigues(turn, R);
    found.push_back({R * cv::Matx33d(1, 0, 0, 0, -1, 0, 0, 0, -1),
                     {shift.at<double>(0), shift.at<double>(1), shift.at<double>(2)},
                     error});
  }
  if (found.empty()) return std::nullopt;
  auto best = *std::ranges::min_element(found, {}, &MarkerPose::error);
  set_ambiguity(best, found);
  return best;
}

EyeCamera camera_of(const StereoCalibration& pair, Eye eye, bool is_rectified) {
  const bool is_right = eye == Eye::Right;
  if (is_rectified) {
    const auto& P = is_right ? pair.P2 : pair.P1;
    return {{{P(0, 0), P(1, 1), P(0, 2), P(1, 2)}, {}}, (is_right ? pair.R2 : pair.R1).t()};
  }
  const auto& M = is_right ? pair.M2 : pair.M1;
  return {{{M(0, 0), M(1, 1), M(0, 2), M(1, 2)}, is_right ? pair.D2 : pair.D1}};
}

}  // namespace hc::vision
