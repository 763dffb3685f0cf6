// SPDX-License-Identifier: Apache-2.0
// Depth from a rectified stereo pair.
#include <cmath>
#include <optional>

#include <frames/module_frames.h>
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <vision/messages.h>
#include <vision/stereo.h>

namespace {

hc::AnyKind image(std::int32_t coord) {
  return hc::any_of(hc::rgb_image<std::uint8_t>().in(coord),
                    hc::intensity_image<std::uint8_t>().in(coord));
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"depth", "Finds the depth of a scene from a rectified stereo pair."};
  auto left =
      module.input("left", image(hc::Coord::kLeftRectified), "rectified image of the left eye");
  auto right =
      module.input("right", image(hc::Coord::kRightRectified), "rectified image of the right eye");
  auto intrinsics = module.input("intrinsics", hc::table<double>(),
                                 "fx, fy, cx, cy [px], baseline [m] of the rectified pair, from "
                                 "rectify; until then focal and baseline apply");
  auto disparity =
      module.output("disparity", hc::intensity_image<float>().in(hc::Coord::kDisparity),
                    "disparity of the left image's pixels [px], 0 unknown");
  auto depth = module.output("depth", hc::intensity_image<float>().in(hc::Coord::kDepth),
                             "depth along the optical axis [m], 0 unknown");
  auto disparities = module.parameter("disparities", 128, "px", "disparities searched",
                                      {.min = 16, .max = 1024, .step = 16, .fixed = true});
  auto block_size = module.parameter("block_size", 5, "px", "side of the window compared",
                                     {.min = 1, .max = 21, .step = 2, .fixed = true});
  auto focal = module.parameter("focal", 800.0, "px", "focal length", {.min = 1e-3});
  auto baseline = module.parameter("baseline", 0.0, "m",
                                   "distance of the cameras, 0: that of the frames left_eye and "
                                   "right_eye",
                                   {.min = 0});
  auto offset = module.parameter("offset", 0.0, "px",
                                 "added to a disparity before depth is computed from it");

  hc::ModuleFrames frames{module, {.input = false}};
  std::optional<hc::vision::StereoMatcher> matcher;
  struct {
    double focal, baseline;
  } measured{};  // by `intrinsics`; 0: not yet
  module.on_start([&] {
    matcher.emplace(
        hc::vision::StereoOptions{static_cast<int>(*disparities), static_cast<int>(*block_size)});
  });
  auto distance = [&] {
    if (measured.baseline > 0) return measured.baseline;
    if (*baseline > 0) return *baseline;
    return frames.fixed("left_eye", "right_eye").translation().norm();
  };
  module.on(intrinsics, [&](const auto& message) {
    const auto numbers = message.matrix().numbers();
    const bool is_pair = numbers.size() == 5 && std::isfinite(numbers[0]) && numbers[0] > 0 &&
                         std::isfinite(numbers[4]) && numbers[4] > 0;
    if (!is_pair) return module.log("intrinsics: not fx, fy, cx, cy, baseline of a pair");
    measured = {numbers[0], numbers[4]};
  });
  module.on(hc::together(left, right), [&](const hc::Message& left_image,
                                           const hc::Message& right_image) {
    const auto& size = left_image.header;
    const auto& other = right_image.header;
    if (size.width != other.width || size.height != other.height)
      throw hc::ModuleError(hc::format("the left image is {} x {}, the right one {} x {}",
                                       size.width, size.height, other.width, other.height));
    if (!matcher->takes({size.width, size.height}))
      throw hc::ModuleError(hc::format("images of {} x {} are not wider than {} disparities",
                                       size.width, size.height, *disparities));
    auto found = disparity.loan(size.width, size.height);
    cv::Mat found_mat = hc::as_mat(found);
    matcher->match(hc::value_or_end(hc::as_mat(left_image)),
                   hc::value_or_end(hc::as_mat(right_image)), found_mat);
    if (!depth.linked()) return disparity.send(std::move(found));
    auto metres = depth.loan(size.width, size.height);
    cv::Mat metres_mat = hc::as_mat(metres);
    hc::vision::depth_of(
        found_mat, {measured.focal > 0 ? measured.focal : *focal, distance(), *offset}, metres_mat);
    disparity.send(std::move(found));
    depth.send(std::move(metres));
  });
  module.background();
  return module.run(argc, argv);
}
