// SPDX-License-Identifier: Apache-2.0
// Rectifies the images of both eyes.
#include <array>
#include <optional>
#include <utility>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <gaze/eyes.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/calibration.h>
#include <vision/messages.h>
#include <vision/rectifier.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  using hc::Coord, hc::vision::Eye, hc::vision::Rectifier;
  hc::Module module{"rectify", "Turns the images of two cameras into a rectified pair."};
  const auto image = hc::rgb_image();
  auto left = module.input("left", image.in(Coord::kLeftImage), "image of the left eye");
  auto right = module.input("right", image.in(Coord::kRightImage), "image of the right eye");
  auto head =
      module.input("calibration", hc::table(), "mounting of the eyes: calibrate's result", {.keep = 1});
  auto left_rectified =
      module.output("left", image.in(Coord::kLeftRectified), "rectified image of the left eye");
  auto right_rectified =
      module.output("right", image.in(Coord::kRightRectified), "rectified image of the right eye");
  auto intrinsics =
      module.output("intrinsics", hc::table().of(1, 5).in(Coord::kLeftRectified),
                    "fx, fy, cx, cy [px], baseline [m] of the rectified pair, with "
                    "the first image and then once a second");
  auto cameras = module.output(
      "cameras", hc::transformation(),
      "with the intrinsics: T_head_left_eye as calibrated (coord 3004), and from the left camera "
      "of the rectified pair to the left eye (coord 4009)", {.on_demand = true});
  auto file = module.parameter(
      "calibration_file", "", "",
      "written by stereo_calibration and calibrate; without it an ideal pair is assumed",
      {.positional = true, .fixed = true});
  auto focal = module.parameter("focal", 800.0, "px", "focal length of an ideal pair",
                                {.min = 1e-3, .max = 1e6, .fixed = true});
  hc::ModuleFrames frames{module, {.input = false}};

  std::optional<hc::vision::StereoCalibration> calibration;
  std::optional<Rectifier> rectifiers[2];
  hc::gaze::HeadCalibration mounting;  // of the eyes; the default if unknown
  bool has_message = false;            // of `calibration`
  bool is_new = true;                  // since `intrinsics` was sent
  std::optional<std::int64_t> time;    // of the last image

  auto send_cameras = [&] {
    if (!cameras.linked()) return;
    hc::gaze::Eyes eyes(frames.fixed("head", "left_eye"), frames.fixed("head", "right_eye"));
    eyes.set_baseline(calibration->baseline());
    if (has_message || !calibration->head.empty()) eyes.calibrate(mounting);
    Eigen::Isometry3d T_left_rectified = Eigen::Isometry3d::Identity();
    T_left_rectified.linear() =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(calibration->R1.val)
            .transpose();
    cameras.send(hc::numbers_of(eyes.T_head_eye(hc::gaze::Side::Left)), *time, hc::transform_coord(Coord::kHead, Coord::kLeftEye));
    cameras.send(hc::numbers_of(T_left_rectified), *time, hc::transform_coord(Coord::kLeftEye, Coord::kLeftRectified));
  };
  auto send_intrinsics = [&] {
    if (!time) return;
    send_cameras();
    const auto camera = calibration->rectified();
    intrinsics.send(
        {camera.fx, camera.fy, camera.cx, camera.cy, calibration->baseline()}, *time);
  };
  auto prepare = [&](Eye eye, const hc::Header& header) {
    const cv::Size size(header.width, header.height);
    auto& rectifier = rectifiers[eye == Eye::Left ? 0 : 1];
    if (rectifier && rectifier->size() == size) return;
    const double baseline = frames.fixed("left_eye", "right_eye").translation().norm();
    if (file->empty()) calibration = hc::vision::ideal_pair(size, *focal, baseline);
    if (calibration->size.area() == 0) calibration->size = size;
    if (has_message) hc::vision::turn(*calibration, mounting.R_left_right());
    rectifier = hc::value_or_drop(Rectifier::make(*calibration, eye, size));
  };

  module.on_start([&] {
    if (file->empty()) return;
    calibration = hc::value_or_end(hc::vision::read_calibration(*file));
    if (!calibration->head.empty())
      mounting = hc::value_or_end(hc::gaze::HeadCalibration::of(calibration->head));
  });
  module.on(head, [&](const auto& message) {
    const auto found = hc::gaze::HeadCalibration::of(message.numbers());
    if (!found) return module.log_once("invalid calibration", found.error().detail);
    if (has_message && found->numbers() == mounting.numbers()) return;  // sent repeatedly
    mounting = *found;
    has_message = is_new = true;
    for (auto& rectifier : rectifiers) rectifier.reset();
  });
  module.on(hc::together(left, right), [&](const auto& first, const auto& second) {
    if (first.header.empty() || second.header.empty()) return;
    const std::array images = {mounting.swapped ? &second : &first,
                               mounting.swapped ? &first : &second};
    prepare(Eye::Left, images[0]->header);
    prepare(Eye::Right, images[1]->header);
    time = first.header.time;
    if (std::exchange(is_new, false)) send_intrinsics();
    std::array drafts = {left_rectified.loan(images[0]->header.height, images[0]->header.width),
                         right_rectified.loan(images[1]->header.height, images[1]->header.width)};
    cv::parallel_for_({0, 2}, [&](const cv::Range& eyes) {
      for (auto eye = static_cast<std::size_t>(eyes.start);
           eye < static_cast<std::size_t>(eyes.end); ++eye)
        hc::fill(drafts[eye],
                 [&](cv::Mat& mat) { rectifiers[eye]->rectify(hc::as_mat(*images[eye]), mat); });
    });
    left_rectified.send(std::move(drafts[0]));
    right_rectified.send(std::move(drafts[1]));
  });
  module.every(std::chrono::seconds(1), send_intrinsics);
  return module.run(argc, argv);
}
