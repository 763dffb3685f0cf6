// SPDX-License-Identifier: Apache-2.0
#include <people/hand_place.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include <hc/base/median.h>

namespace hc::people {
namespace {

/// What moves least while fingers bend.
constexpr std::array<std::size_t, 5> kPalm = {Hand::Wrist, Hand::Index, Hand::Middle, Hand::Ring,
                                              Hand::Little};

/// The point of a pixel, at a depth.
Eigen::Vector3d at(const cv::Point2f& pixel, double z, const vision::Pinhole& camera) {
  return {z * (static_cast<double>(pixel.x) - camera.cx) / camera.fx,
          z * (static_cast<double>(pixel.y) - camera.cy) / camera.fy, z};
}

/// By how much points of both rectified eyes differ in height, and in disparity from the middle
/// one. [px], summed
float misfit(const Hand& left, const Hand& right) {
  std::vector<float> disparities;
  for (std::size_t i = 0; i < Hand::kPoints; ++i)
    disparities.push_back(left.points[i].x - right.points[i].x);
  const float middle = median(disparities);
  float sum = 0;
  for (std::size_t i = 0; i < Hand::kPoints; ++i)
    sum += std::abs(disparities[i] - middle) + std::abs(left.points[i].y - right.points[i].y);
  return sum;
}

}  // namespace

std::optional<Joints> joints_of(const Hand& hand, const vision::Pinhole& camera) {
  // The place t of the hand for which f · (p + t).x = x · (p + t).z, with x counted from the
  // principal point, and likewise for y: linear in t, with least squares.
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  const auto add = [&](const Eigen::Vector3d& row, double right) {
    A += row * row.transpose();
    b += row * right;
  };
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    const double x = (hand.points[i].x - camera.cx) / camera.fx;
    const double y = (hand.points[i].y - camera.cy) / camera.fy;
    const cv::Point3d p = hand.world[i];
    add({1, 0, -x}, x * p.z - p.x);
    add({0, 1, -y}, y * p.z - p.y);
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(A);
  if (!lu.isInvertible()) return std::nullopt;
  const Eigen::Vector3d t = lu.solve(b);
  Joints joints;
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    const double z = static_cast<double>(hand.world[i].z) + t.z();
    if (!(z > 0)) return std::nullopt;
    joints[i] = at(hand.points[i], z, camera);
  }
  return joints;
}

double depth_of(const Joints& joints) {
  double sum = 0;
  for (const auto i : kPalm) sum += joints[i].z();
  return sum / static_cast<double>(kPalm.size());
}

Joints moved_to(Joints joints, double depth) {
  const double scale = depth / depth_of(joints);
  for (auto& joint : joints) joint *= scale;
  return joints;
}

std::optional<double> depth_in(const cv::Mat& depth, const Hand& hand) {
  // Between the wrist and each knuckle, where there is skin and no gap.
  std::vector<float> known;
  int count = 0;
  for (const auto knuckle : kPalm) {
    if (knuckle == Hand::Wrist) continue;
    for (const float share : {0.3F, 0.5F, 0.7F, 0.9F}) {
      const cv::Point2f at = hand.points[Hand::Wrist] * (1 - share) + hand.points[knuckle] * share;
      const cv::Point pixel(static_cast<int>(std::lround(at.x)),
                            static_cast<int>(std::lround(at.y)));
      ++count;
      if (!cv::Rect({}, depth.size()).contains(pixel)) continue;
      if (const float metres = depth.at<float>(pixel); metres > 0 && std::isfinite(metres))
        known.push_back(metres);
    }
  }
  if (2 * static_cast<int>(known.size()) < count) return std::nullopt;
  return median(std::move(known));
}

std::optional<Joints> joints_by_eyes(const Hand& left, const Hand& seen_by_right,
                                     const vision::Pinhole& camera, double baseline) {
  constexpr float kApart = 0.1F;   // maximum difference of height, of the hand's size
  constexpr double kDepth = 0.12;  // maximum distance of a joint from the middle one, in depth [m]
  // Seen from its side, a hand may have its fingers in another order in each eye.
  const Hand reversed = with_fingers_reversed(seen_by_right);
  const Hand& right =
      misfit(left, reversed) < misfit(left, seen_by_right) ? reversed : seen_by_right;
  std::vector<float> disparities, heights;
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    const cv::Point2f by = left.points[i] - right.points[i];
    disparities.push_back(by.x);
    heights.push_back(std::abs(by.y));
  }
  const cv::Rect2f box = left.box();
  const auto middle = static_cast<double>(median(disparities));
  if (median(heights) > kApart * std::max(box.width, box.height) || !(middle > 0))
    return std::nullopt;
  const double depth = camera.fx * baseline / middle;
  Joints joints;
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    const double own = camera.fx * baseline / std::max(static_cast<double>(disparities[i]), 1e-3);
    joints[i] = at(left.points[i],
                   std::clamp(own, std::max(depth - kDepth, depth / 2), depth + kDepth), camera);
  }
  return joints;
}

Region region_in_right(const Hand& left, double disparity) {
  Region region = region_of(left);
  region.middle.x -= static_cast<float>(disparity);
  return region;
}

}  // namespace hc::people
