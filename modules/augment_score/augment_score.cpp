// SPDX-License-Identifier: Apache-2.0
#include "augment_score.h"

#include <algorithm>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <hc/base/median.h>
#include <vision/messages.h>

namespace {

/// The share of an object's pixels whose visibility is right.
///
/// @param object  its depth (H, W) f32 [m], 0 elsewhere. @param scene  depth without the object.
/// @returns  nothing if the object covers too few pixels.
std::optional<double> share_right(const cv::Mat& object, const cv::Mat& scene,
                                  const cv::Mat& mask) {
  constexpr int kLeast = 500;  // [px]
  int pixels = 0, right = 0;
  for (int y = 0; y < object.rows; ++y)
    for (int x = 0; x < object.cols; ++x) {
      const float z = object.at<float>(y, x), before = scene.at<float>(y, x);
      if (z == 0) continue;
      const bool is_seen = before == 0 || z < before;
      ++pixels;
      if (is_seen == (mask.at<std::uint8_t>(y, x) > 127)) ++right;
    }
  if (pixels < kLeast) return std::nullopt;
  return static_cast<double>(right) / pixels;
}

}  // namespace

hc::graphics::PinholeCamera AugmentScoreParameters::camera(const hc::Header& image) const {
  hc::graphics::PinholeCamera camera;
  camera.width = image.width;
  camera.height = image.height;
  camera.fx = camera.fy = *focal;
  camera.cx = (camera.width - 1) / 2.0;
  camera.cy = (camera.height - 1) / 2.0;
  return camera;
}

AugmentScore::AugmentScore(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(hc::together(left_pose_, right_pose_, depth_, corners_, mask_),
            [this](const auto& left, const auto& right, const auto& scene, const auto& corners,
                   const auto& mask) {
              waits_ = 0;
              compare(left.header.time,
                      {hc::value_or_drop(hc::pose_of(left)).T_to_from,
                       hc::value_or_drop(hc::pose_of(right)).T_to_from},
                      scene, corners.numbers(), mask);
            });
  module.every(kLook, [this] { check_timeout(); });
}

void AugmentScore::start() {
  renderer_ = hc::value_or_end(hc::graphics::Renderer::make());
  cube_ = hc::graphics::make_body(*renderer_, {{hc::graphics::make_box({1, 1, 1}),
                                                cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(255))}});
  cube_.set_size(*parameters_.size);
  cube_.T_world_body = Eigen::Translation3d(*parameters_.x, *parameters_.y, *parameters_.z);
}

void AugmentScore::compare(hc::Time time, const Eyes& eyes, const hc::Message& scene,
                           std::span<const double> corners, const hc::Message& mask) {
  const double rate = turn(time, eyes[0]);
  if (rate < *parameters_.turning) return;
  samples_.fastest = std::max(samples_.fastest, rate);
  camera_ = parameters_.camera(scene.header);
  compare_corners(eyes, corners);
  compare_mask(eyes[0], hc::value_or_drop(hc::as_mat(scene)), hc::value_or_drop(hc::as_mat(mask)));
  if (static_cast<std::int64_t>(samples_.right.size()) >= *parameters_.images) finish();
}

double AugmentScore::turn(hc::Time time, const Eigen::Isometry3d& T_world_left) {
  double rate = 0;
  if (last_ && time > last_->first)
    rate = Eigen::AngleAxisd(last_->second.linear().transpose() * T_world_left.linear()).angle() /
           hc::seconds(time - last_->first);
  last_.emplace(time, T_world_left);
  return rate;
}

void AugmentScore::compare_corners(const Eyes& eyes, std::span<const double> found) {
  const auto all = cube_.corners();
  if (found.size() != 4 * all.size()) throw hc::BadMessage("corners: not those of one object");
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const Eigen::Vector3d p = eyes[eye].inverse() * all[i];
      if (p.z() < camera_.near) continue;
      const Eigen::Vector2d truth = camera_.project(p);
      const Eigen::AlignedBox2d image(Eigen::Vector2d(0, 0),
                                      Eigen::Vector2d(camera_.width, camera_.height));
      if (!image.contains(truth)) continue;
      const Eigen::Vector2d seen(found[4 * i + 2 * eye], found[4 * i + 2 * eye + 1]);
      samples_.errors.push_back((seen - truth).norm());
    }
}

void AugmentScore::compare_mask(const Eigen::Isometry3d& T_world_left, const cv::Mat& scene,
                                const cv::Mat& found) {
  cv::Mat rgb, object;
  hc::succeed_or_end(renderer_->draw(cube_.items(), camera_, T_world_left, {}, rgb, &object));
  if (const auto share = share_right(object, scene, found)) samples_.right.push_back(*share);
}

void AugmentScore::finish() {
  const double error = hc::median(samples_.errors), share = hc::median(samples_.right);
  const double worst = *std::ranges::max_element(samples_.errors);
  const double least = *std::ranges::min_element(samples_.right);
  result_.send(
      {error, worst, share, least, samples_.fastest, static_cast<double>(samples_.right.size())});
  module_.log(
      hc::format("corners off by {:.2f} px median, {:.2f} px at most, pixels right {:.1f} % "
                 "median, {:.1f} % at least, the head turning at up to {:.0f}°/s",
                 error, worst, 100 * share, 100 * least, samples_.fastest * 57.29578),
      hc::Level::Result);
  module_.stop();
}

void AugmentScore::check_timeout() {
  if (++waits_ * kLook > hc::duration(*parameters_.timeout))
    throw hc::ModuleError("no image within timeout");
}
