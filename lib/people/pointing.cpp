// SPDX-License-Identifier: Apache-2.0
#include <people/pointing.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace hc::people {

Ray pointing_ray(const Joints& joints, const std::optional<Eigen::Vector3d>& eye) {
  const Eigen::Vector3d& tip = joints[Hand::IndexTip];
  const Eigen::Vector3d finger = (tip - joints[Hand::Index]).normalized();
  if (eye) {
    const Eigen::Vector3d aim = (tip - *eye).normalized();
    if (std::acos(std::clamp(aim.dot(finger), -1.0, 1.0)) < kAim) return {tip, aim, true};
  }
  return {tip, finger, false};
}

std::optional<Eigen::Vector3d> place_pointed_at(const Ray& ray, const cv::Mat& depth,
                                                const vision::Pinhole& camera, const Reach& reach) {
  constexpr double kNearest = 0.05;    // z of what the camera sees [m]
  constexpr double kLeastStep = 1e-4;  // along the ray [m]: a focal length may be any number
  const cv::Rect image({}, depth.size());
  struct Step {
    double at = 0, before = 0;  // along the ray; of the ray before the surface [m]
  };
  Step last;  // before a surface, if `before` is not 0
  for (double at = reach.first; at < reach.last;) {
    const Eigen::Vector3d p = ray.from + at * ray.direction;
    if (p.z() < kNearest) return std::nullopt;
    const cv::Point pixel(static_cast<int>(std::lround(camera.fx * p.x() / p.z() + camera.cx)),
                          static_cast<int>(std::lround(camera.fy * p.y() / p.z() + camera.cy)));
    if (!image.contains(pixel)) return std::nullopt;
    if (const float surface = depth.at<float>(pixel); surface > 0 && std::isfinite(surface)) {
      const double before = static_cast<double>(surface) - p.z();
      if (before > 0) {
        last = {at, before};
      } else if (last.before > 0 && -before < reach.thickness) {
        const double share = last.before / (last.before - before);
        return ray.from + (last.at + share * (at - last.at)) * ray.direction;
      } else {
        last = {};  // out of sight
      }
    }
    // Less than a pixel further, or kLeastStep.
    at += std::max(p.z() / std::max(camera.fx, camera.fy), kLeastStep);
  }
  return std::nullopt;
}

}  // namespace hc::people
