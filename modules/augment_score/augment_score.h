// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scores the registration and occlusion of a virtual object while the head turns, against the
// ground truth of a simulation.

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <graphics/overlay.h>
#include <hc/module/module.h>
#include <opencv2/core.hpp>

struct AugmentScoreParameters {
  hc::Module& module;

  hc::Parameter<double> x =
      module.parameter("x", 2.75, "m", "middle of the cube in the world", {.fixed = true});
  hc::Parameter<double> y = module.parameter("y", 0.35, "m", "the same", {.fixed = true});
  hc::Parameter<double> z = module.parameter("z", 0.7, "m", "the same", {.fixed = true});
  hc::Parameter<double> size =
      module.parameter("size", 0.3, "m", "of the cube", {.min = 1e-3, .max = 100, .fixed = true});
  hc::Parameter<double> focal =
      module.parameter("focal", 600.0, "px", "of the eyes", {.min = 1, .max = 1e6});
  hc::Parameter<double> turning = module.parameter(
      "turning", 0.7, "rad/s", "minimum speed of the head at which images are scored", {.min = 0});
  hc::Parameter<std::int64_t> images =
      module.parameter("images", 100, "", "to be scored", {.min = 1, .max = 1e6});
  hc::Parameter<double> timeout =
      module.parameter("timeout", 60.0, "s", "to wait for an image", {.min = 1, .max = 3600});

  /// Of both eyes.
  [[nodiscard]] hc::graphics::PinholeCamera camera(const hc::Header& image) const;
};

class AugmentScore {
 public:
  /// @param module  must outlive it.
  explicit AugmentScore(hc::Module& module);

 private:
  /// Collected while the head turns fast enough.
  struct Samples {
    std::vector<double> errors;  ///< of corners [px]
    std::vector<double> right;   ///< share of the object's pixels that are right, of each image
    double fastest = 0;          ///< [rad/s]
  };
  using Eyes = std::array<Eigen::Isometry3d, 2>;  // T_world_eye, left and right
  static constexpr std::chrono::milliseconds kLook{50};
  static constexpr auto kWorldLeftEye = hc::transform_coord(hc::Coord::kWorld, hc::Coord::kLeftEye);
  static constexpr auto kWorldRightEye =
      hc::transform_coord(hc::Coord::kWorld, hc::Coord::kRightEye);

  void start();
  void compare(hc::Time time, const Eyes& eyes, const hc::Message& scene,
               std::span<const double> corners, const hc::Message& mask);
  /// Angular speed of the head since the previous pose [rad/s].
  double turn(hc::Time time, const Eigen::Isometry3d& T_world_left);
  void compare_corners(const Eyes& eyes, std::span<const double> found);
  void compare_mask(const Eigen::Isometry3d& T_world_left, const cv::Mat& scene,
                    const cv::Mat& found);
  void finish();
  void check_timeout();

  hc::Module& module_;
  hc::Input<hc::TransformationKind<double>> left_pose_ =
      module_.input("left_pose", hc::transformation().in(kWorldLeftEye), "truth: T_world_left_eye");
  hc::Input<hc::TransformationKind<double>> right_pose_ = module_.input(
      "right_pose", hc::transformation().in(kWorldRightEye), "truth: T_world_right_eye");
  hc::Input<hc::IntensityImageKind<float>> depth_ = module_.input(
      "depth", hc::intensity_image<float>().in(hc::Coord::kDepth), "truth: of the left image [m]");
  hc::Input<hc::TableKind<double>> corners_ = module_.input("corners", hc::table(), "from augment");
  hc::Input<hc::IntensityImageKind<std::uint8_t>> mask_ =
      module_.input("mask", hc::intensity_image(), "from augment");
  hc::Output<hc::TableKind<double>> result_ =
      module_.output("score", hc::table().of(1, 6),
                     "reprojection error of the corners, median and most [px], share of "
                     "the object's pixels that are right, median and minimum, fastest head motion "
                     "[rad/s], images");
  const AugmentScoreParameters parameters_{module_};

  std::unique_ptr<hc::graphics::Renderer> renderer_;
  hc::graphics::Body cube_;
  hc::graphics::PinholeCamera camera_;
  Samples samples_;
  std::optional<std::pair<hc::Time, Eigen::Isometry3d>> last_;  // time and T_world_left_eye
  std::int64_t waits_ = 0;                                      // periods since an image
};
