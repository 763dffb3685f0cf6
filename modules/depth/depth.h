// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth from a rectified stereo pair.

#include <cstdint>
#include <memory>
#include <string>

#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <vision/module_cameras.h>
#include <vision/stereo/depth.h>
#include <vision/stereo/matcher.h>

struct DepthParameters {
  hc::Module& module;

  hc::Parameter<std::string> matcher =
      module.parameter("matcher", "semi_global", "", "how images are matched",
                       {.choices = {"semi_global", "opencv"}, .fixed = true});
  hc::Parameter<std::int64_t> disparities =
      module.parameter("disparities", 128, "px", "disparities searched",
                       {.min = 16, .max = 256, .step = 16, .fixed = true});
  hc::Parameter<std::int64_t> speckle_size =
      module.parameter("speckle_size", 100, "px", "smaller patches are removed",
                       {.min = 0, .max = 1e6, .fixed = true});
  hc::Parameter<std::int64_t> block_size =
      module.parameter("block_size", 5, "px", "side of the window compared by the matcher opencv",
                       {.min = 1, .max = 21, .step = 2, .fixed = true});
  hc::Parameter<double> offset = module.parameter(
      "offset", 0.0, "px", "added to a disparity before depth is computed from it");

  [[nodiscard]] std::unique_ptr<hc::vision::StereoMatcher> make_matcher() const;
};

class Depth {
 public:
  /// @param module  must outlive it.
  explicit Depth(hc::Module& module);

 private:
  void match(const hc::Message& left, const hc::Message& right);
  void send_right_depth(const cv::Mat& disparity, const hc::Header& image);
  void send_points(const cv::Mat& metres, const cv::Mat& left, const hc::Header& image);
  hc::vision::StereoGeometry geometry(const hc::Header& image);

  hc::Module& module_;
  hc::Input<hc::ImageKind> left_ = module_.input("left", hc::image(hc::Coord::kLeftRectified),
                                                 "rectified image of the left eye");
  hc::Input<hc::ImageKind> right_ = module_.input("right", hc::image(hc::Coord::kRightRectified),
                                                  "rectified image of the right eye");
  hc::Output<hc::IntensityImageKind<float>> disparity_ =
      module_.output("disparity", hc::intensity_image<float>().in(hc::Coord::kDisparity),
                     "disparity of the left image's pixels [px], 0 unknown");
  hc::Output<hc::IntensityImageKind<float>> depth_ =
      module_.output("depth", hc::intensity_image<float>().in(hc::Coord::kDepth),
                     "depth along the optical axis [m], 0 unknown");
  hc::Output<hc::IntensityImageKind<std::uint8_t>> confidence_ = module_.output(
      "confidence", hc::intensity_image().in(hc::Coord::kDisparity),
      "confidence of the disparity: 1 lowest, 255 highest, 0 unknown", {.on_demand = true});
  hc::Output<hc::VectorFieldKind<float>> points_ =
      module_.output("points", hc::vector_field<float>(6).in(hc::Coord::kLeftEye),
                     "point of each pixel: x, y, z [m] in the frame left_eye, red, green, "
                     "blue [0, 1]; NaN unknown",
                     {.on_demand = true});
  hc::Output<hc::IntensityImageKind<float>> right_depth_ =
      module_.output("right_depth", hc::intensity_image<float>().in(hc::Coord::kRightDepth),
                     "depth of the right image's pixels [m], 0 unknown", {.on_demand = true});
  const DepthParameters parameters_{module_};

  hc::ModuleFrames frames_{module_, {.input = false}};
  hc::vision::ModulePair pair_{module_, frames_, "depths have no true scale"};
  std::unique_ptr<hc::vision::StereoMatcher> matcher_;
  cv::Mat right_disparity_;  // memory
};
