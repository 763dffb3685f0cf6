// SPDX-License-Identifier: Apache-2.0
// Depth from a rectified stereo pair.
#include <cmath>
#include <memory>
#include <utility>

#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>
#include <vision/stereo/depth.h>
#include <vision/stereo/matcher.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"depth", "Finds the depth of a scene from a rectified stereo pair.", {.background = true}};
  auto left = module.input("left", hc::image(hc::Coord::kLeftRectified),
                           "rectified image of the left eye");
  auto right = module.input("right", hc::image(hc::Coord::kRightRectified),
                            "rectified image of the right eye");
  auto intrinsics = module.input("intrinsics", hc::table(),
                                 "fx, fy, cx, cy [px], baseline [m] of the rectified pair, from "
                                 "rectify; until then focal and baseline apply");
  auto disparity =
      module.output("disparity", hc::intensity_image<float>().in(hc::Coord::kDisparity),
                    "disparity of the left image's pixels [px], 0 unknown");
  auto depth = module.output("depth", hc::intensity_image<float>().in(hc::Coord::kDepth),
                             "depth along the optical axis [m], 0 unknown");
  auto confidence =
      module.output("confidence", hc::intensity_image().in(hc::Coord::kDisparity),
                    "confidence of the disparity: 1 lowest, 255 highest, 0 unknown", {.on_demand = true});
  auto points = module.output("points", hc::vector_field<float>(6).in(hc::Coord::kLeftEye),
                              "point of each pixel: x, y, z [m] in the frame left_eye, red, green, "
                              "blue [0, 1]; NaN unknown", {.on_demand = true});
  auto matcher_name = module.parameter("matcher", "semi_global", "", "how images are matched",
                                       {.choices = {"semi_global", "opencv"}, .fixed = true});
  auto disparities = module.parameter("disparities", 128, "px", "disparities searched",
                                      {.min = 16, .max = 256, .step = 16, .fixed = true});
  auto speckle_size = module.parameter("speckle_size", 100, "px", "smaller patches are removed",
                                       {.min = 0, .max = 1e6, .fixed = true});
  auto block_size =
      module.parameter("block_size", 5, "px", "side of the window compared by the matcher opencv",
                       {.min = 1, .max = 21, .step = 2, .fixed = true});
  auto focal = module.parameter("focal", 800.0, "px", "focal length", {.min = 1e-3});
  auto baseline = module.parameter("baseline", 0.0, "m",
                                   "distance of the cameras, 0: that of the frames left_eye and "
                                   "right_eye",
                                   {.min = 0});
  auto offset = module.parameter("offset", 0.0, "px",
                                 "added to a disparity before depth is computed from it");

  hc::ModuleFrames frames{module, {.input = false}};
  std::unique_ptr<hc::vision::StereoMatcher> matcher;
  hc::vision::StereoGeometry measured;  // by `intrinsics`; focal 0: not yet
  module.on_start([&] {
    const hc::vision::StereoOptions options{static_cast<int>(*disparities),
                                            static_cast<int>(*speckle_size)};
    matcher = *matcher_name == "opencv"
                  ? hc::vision::opencv_matcher(options, static_cast<int>(*block_size))
                  : hc::vision::semi_global_matcher(options);
  });
  auto geometry = [&](const hc::Header& image) {
    auto found = measured;
    if (found.focal == 0) {
      found = {.focal = *focal,
               .baseline = *baseline,
               .cx = (image.width - 1) / 2.0,
               .cy = (image.height - 1) / 2.0};
      if (found.baseline == 0)
        found.baseline = frames.fixed("left_eye", "right_eye").translation().norm();
    }
    found.offset = *offset;
    return found;
  };
  module.on(intrinsics, [&](const auto& message) {
    const auto numbers = message.matrix().numbers();
    const bool is_pair = numbers.size() == 5 && std::isfinite(numbers[0]) && numbers[0] > 0 &&
                         std::isfinite(numbers[4]) && numbers[4] > 0;
    if (!is_pair) return module.log("intrinsics: not fx, fy, cx, cy, baseline of a pair");
    measured = {.focal = numbers[0], .baseline = numbers[4], .cx = numbers[2], .cy = numbers[3]};
  });
  module.on(hc::together(left, right), [&](const hc::Message& left_image,
                                           const hc::Message& right_image) {
    const auto width = left_image.header.width, height = left_image.header.height;
    const cv::Mat left_mat = hc::value_or_drop(hc::as_mat(left_image));
    auto disparity_draft = disparity.loan(height, width);
    auto confidence_draft = confidence.loan(height, width);
    auto depth_draft = depth.loan(height, width);
    hc::vision::Disparities found{hc::as_mat(disparity_draft), hc::as_mat(confidence_draft)};
    const cv::Mat right_mat = hc::value_or_drop(hc::as_mat(right_image));
    if (auto matched = matcher->match(left_mat, right_mat, found); !matched)
      throw hc::BadMessage(matched.error().detail);
    cv::Mat metres = hc::as_mat(depth_draft);
    if (depth.linked() || points.linked())
      hc::vision::depth_of(found.disparity, geometry(left_image.header), metres);
    if (points.linked()) {
      auto draft = points.loan(height, width);
      cv::Mat mat = hc::as_mat(draft);
      hc::vision::points_of(metres, left_mat, geometry(left_image.header), mat);
      points.send(std::move(draft));
    }
    disparity.send(std::move(disparity_draft));
    confidence.send(std::move(confidence_draft));
    depth.send(std::move(depth_draft));
  });
  return module.run(argc, argv);
}
