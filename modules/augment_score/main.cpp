// SPDX-License-Identifier: Apache-2.0
// Scores the registration and occlusion of a virtual object while the head turns, against the
// ground truth of a simulation.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <frames/messages.h>
#include <graphics/overlay.h>
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>

namespace {

using hc::Coord, hc::graphics::Body;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Collected while the head turns fast enough.
struct Samples {
  std::vector<double> errors;  ///< of corners [px]
  std::vector<double> right;   ///< share of the object's pixels that are right, of each image
  double fastest = 0;          ///< [rad/s]
};

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

int main(int argc, char** argv) {
  hc::add_all_transports();
  constexpr auto kWorldLeftEye = hc::transform_coord(Coord::kWorld, Coord::kLeftEye);
  constexpr auto kWorldRightEye = hc::transform_coord(Coord::kWorld, Coord::kRightEye);
  hc::Module module{"augment_score",
                    "Compares where augment draws a cube with where a real one would be seen."};
  auto left_pose =
      module.input("left_pose", hc::transformation().in(kWorldLeftEye), "truth: T_world_left_eye");
  auto right_pose = module.input("right_pose", hc::transformation().in(kWorldRightEye),
                                 "truth: T_world_right_eye");
  auto depth = module.input("depth", hc::intensity_image<float>().in(Coord::kDepth),
                            "truth: of the left image [m]");
  auto corners = module.input("corners", hc::table(), "from augment");
  auto mask = module.input("mask", hc::intensity_image(), "from augment");
  auto result =
      module.output("score", hc::table().of(1, 6),
                    "reprojection error of the corners, median and most [px], share of "
                    "the object's pixels that are right, median and minimum, fastest head motion "
                    "[rad/s], images");
  auto x = module.parameter("x", 2.75, "m", "middle of the cube in the world", {.fixed = true});
  auto y = module.parameter("y", 0.35, "m", "the same", {.fixed = true});
  auto z = module.parameter("z", 0.7, "m", "the same", {.fixed = true});
  auto size =
      module.parameter("size", 0.3, "m", "of the cube", {.min = 1e-3, .max = 100, .fixed = true});
  auto focal = module.parameter("focal", 600.0, "px", "of the eyes", {.min = 1, .max = 1e6});
  auto turning = module.parameter(
      "turning", 0.7, "rad/s", "minimum speed of the head at which images are scored", {.min = 0});
  auto images = module.parameter("images", 100, "", "to be scored", {.min = 1, .max = 1e6});
  auto timeout =
      module.parameter("timeout", 60.0, "s", "to wait for an image", {.min = 1, .max = 3600});

  std::unique_ptr<hc::graphics::Renderer> renderer;
  Body cube;
  hc::graphics::PinholeCamera camera;
  Samples samples;
  std::optional<std::pair<std::int64_t, Eigen::Isometry3d>> last;  // time and T_world_left_eye
  std::int64_t waits = 0;                                          // periods since an image

  /// Angular speed of the head since the previous pose [rad/s].
  auto turn = [&](std::int64_t time, const Eigen::Isometry3d& pose) {
    double rate = 0;
    if (last && time > last->first)
      rate = Eigen::AngleAxisd(last->second.linear().transpose() * pose.linear()).angle() /
             hc::seconds(time - last->first);
    last.emplace(time, pose);
    return rate;
  };
  auto compare_corners = [&](const std::array<Eigen::Isometry3d, 2>& eyes,
                             std::span<const double> found) {
    const auto all = cube.corners();
    if (found.size() != 4 * all.size()) throw hc::BadMessage("corners: not those of one object");
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t eye = 0; eye < 2; ++eye) {
        const Eigen::Vector3d p = eyes[eye].inverse() * all[i];
        if (p.z() < camera.near) continue;
        const Eigen::Vector2d truth = camera.project(p);
        const Eigen::AlignedBox2d image(Eigen::Vector2d(0, 0),
                                        Eigen::Vector2d(camera.width, camera.height));
        if (!image.contains(truth)) continue;
        const Eigen::Vector2d seen(found[4 * i + 2 * eye], found[4 * i + 2 * eye + 1]);
        samples.errors.push_back((seen - truth).norm());
      }
  };
  auto compare_mask = [&](const Eigen::Isometry3d& T_world_left, const cv::Mat& scene,
                          const cv::Mat& found) {
    cv::Mat rgb, object;
    hc::succeed_or_end(renderer->draw(cube.items(), camera, T_world_left, {}, rgb, &object));
    if (const auto share = share_right(object, scene, found)) samples.right.push_back(*share);
  };

  module.on_start([&] {
    renderer = hc::value_or_end(hc::graphics::Renderer::make());
    cube = hc::graphics::make_body(*renderer, {{hc::graphics::make_box({1, 1, 1}),
                                                cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(255))}});
    cube.set_size(*size);
    cube.T_world_body = Eigen::Translation3d(*x, *y, *z);
  });
  auto finish = [&] {
    const double error = median(samples.errors), share = median(samples.right);
    const double worst = *std::ranges::max_element(samples.errors);
    const double least = *std::ranges::min_element(samples.right);
    result.send(
        {error, worst, share, least, samples.fastest, static_cast<double>(samples.right.size())});
    module.log(
        hc::format("corners off by {:.2f} px median, {:.2f} px at most, pixels right {:.1f} % "
                   "median, {:.1f} % at least, the head turning at up to {:.0f}°/s",
                   error, worst, 100 * share, 100 * least, samples.fastest * 57.29578),
        hc::Level::Result);
    module.stop();
  };
  module.on(hc::together(left_pose, right_pose, depth, corners, mask),
            [&](const auto& left, const auto& right, const auto& scene, const auto& found_corners,
                const auto& found_mask) {
              waits = 0;
              const std::array eyes = {hc::value_or_drop(hc::pose_of(left)).T_to_from,
                                       hc::value_or_drop(hc::pose_of(right)).T_to_from};
              const double rate = turn(left.header.time, eyes[0]);
              if (rate < *turning) return;
              samples.fastest = std::max(samples.fastest, rate);
              camera.width = scene.header.width;
              camera.height = scene.header.height;
              camera.fx = camera.fy = *focal;
              camera.cx = (camera.width - 1) / 2.0;
              camera.cy = (camera.height - 1) / 2.0;
              compare_corners(eyes, found_corners.numbers());
              compare_mask(eyes[0], hc::as_mat(scene), hc::as_mat(found_mask));
              if (static_cast<std::int64_t>(samples.right.size()) >= *images) finish();
            });
  constexpr std::chrono::milliseconds kLook{50};
  module.every(kLook, [&] {
    if (++waits * kLook > hc::duration(*timeout)) throw hc::ModuleError("no image within timeout");
  });
  return module.run(argc, argv);
}
