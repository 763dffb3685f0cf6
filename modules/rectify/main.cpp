// SPDX-License-Identifier: Apache-2.0
// The pictures of both eyes, rectified.
#include <optional>
#include <utility>

#include <gaze/eyes.h>
#include <hc/module/module.h>
#include <vision/calibration.h>
#include <vision/messages.h>
#include <vision/rectifier.h>

namespace {

constexpr std::int32_t kLeftImage = 7, kRightImage = 8, kLeftRectified = 9, kRightRectified = 10;

}  // namespace

int main(int argc, char** argv) {
  using hc::vision::Eye, hc::vision::Rectifier;
  hc::Module module{"rectify", "Turns the pictures of two cameras into a rectified pair."};
  auto left =
      module.input("left", hc::rgb_image<std::uint8_t>().in(kLeftImage), "picture of the left eye");
  auto right = module.input("right", hc::rgb_image<std::uint8_t>().in(kRightImage),
                            "picture of the right eye");
  auto head = module.input("calibration", hc::table<double>(),
                           "how the eyes sit on a head: calibrate's result");
  auto left_rectified = module.output("left", hc::rgb_image<std::uint8_t>().in(kLeftRectified),
                                      "rectified picture of the left eye");
  auto right_rectified = module.output("right", hc::rgb_image<std::uint8_t>().in(kRightRectified),
                                       "rectified picture of the right eye");
  auto intrinsics = module.output("intrinsics", hc::table<double>(),
                                  "fx, fy, cx, cy [px], baseline [m] of the rectified pair, with "
                                  "the first picture and then once a second");
  auto file =
      module.parameter("calibration_file", "", "",
                       "what stereo_calibration and calibrate wrote; without it an ideal pair "
                       "is assumed",
                       {.positional = true, .fixed = true});
  auto focal = module.parameter("focal", 800.0, "px", "focal length of an ideal pair",
                                {.min = 1e-3, .max = 1e6, .fixed = true});
  auto baseline = module.parameter("baseline", 0.1, "m", "distance of the eyes of an ideal pair",
                                   {.min = 1e-6, .max = 1000, .fixed = true});

  std::optional<hc::vision::StereoCalibration> calibration;
  std::optional<Rectifier> rectifiers[2];
  hc::gaze::HeadCalibration seat;    // how the eyes sit, as far as it is known
  bool is_told = false;              // by `calibration`
  bool is_new = true;                // what `intrinsics` tells
  std::optional<std::int64_t> time;  // of the last picture
  auto tell = [&] {
    if (!time) return;
    const auto camera = calibration->rectified();
    auto numbers = hc::table({camera.fx, camera.fy, camera.cx, camera.cy, calibration->baseline()});
    numbers.header.time = *time;
    intrinsics.send(numbers);
  };
  auto rectify = [&](const auto& picture, auto& output, Eye eye) {
    const cv::Size size(picture.header.width, picture.header.height);
    if (size.area() == 0) return;
    auto& rectifier = rectifiers[eye == Eye::Left ? 0 : 1];
    if (!rectifier || rectifier->size() != size) {
      if (file->empty()) calibration = hc::vision::ideal_pair(size, *focal, *baseline);
      if (calibration->size.area() == 0) calibration->size = size;
      if (is_told) hc::vision::turn(*calibration, seat.R_left_right());
      rectifier = hc::value_or_end(Rectifier::make(*calibration, eye, size));
    }
    time = picture.header.time;
    if (std::exchange(is_new, false)) tell();
    if (!output.linked()) return;
    auto draft = output.loan(size.width, size.height);
    cv::Mat rectified = hc::as_mat(draft);
    rectifier->rectify(hc::as_mat(picture), rectified);
    output.send(std::move(draft));
  };
  module.on_start([&] {
    if (file->empty()) return;
    calibration = hc::value_or_end(hc::vision::read_calibration(*file));
    if (!calibration->head.empty())
      seat = hc::value_or_end(hc::gaze::HeadCalibration::of(calibration->head));
  });
  module.on(head, [&](const auto& message) {
    const auto found = hc::gaze::HeadCalibration::of(message.matrix().numbers());
    if (!found) return module.log("calibration: " + found.error().detail);
    if (is_told && found->numbers() == seat.numbers()) return;  // it is told again and again
    seat = *found;
    is_told = is_new = true;
    for (auto& rectifier : rectifiers) rectifier.reset();
  });
  auto take = [&](const auto& picture, Eye plug) {
    const Eye other = plug == Eye::Left ? Eye::Right : Eye::Left;
    const Eye eye = seat.swapped ? other : plug;
    rectify(picture, eye == Eye::Left ? left_rectified : right_rectified, eye);
  };
  module.on(left, [&](const auto& picture) { take(picture, Eye::Left); });
  module.on(right, [&](const auto& picture) { take(picture, Eye::Right); });
  module.every(std::chrono::seconds(1), tell);
  return module.run(argc, argv);
}
