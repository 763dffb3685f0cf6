// SPDX-License-Identifier: Apache-2.0
#pragma once
// Rectifies the images of both eyes.

#include <cstdint>
#include <optional>
#include <string>

#include <frames/module_frames.h>
#include <gaze/eyes.h>
#include <hc/module/module.h>
#include <vision/calibration.h>
#include <vision/module_cameras.h>
#include <vision/rectifier.h>

struct RectifyParameters {
  hc::Module& module;

  hc::Parameter<std::string> calibration_file = module.parameter(
      "calibration_file", "", "",
      "written by stereo_calibration and calibrate; without it an ideal pair is assumed",
      {.positional = true, .fixed = true});
  hc::Parameter<double> focal =
      module.parameter("focal", hc::vision::kUnknownFocal, "px",
                       "focal length of an ideal pair; 0: unknown, the images' width is assumed",
                       {.min = 0, .max = 1e6, .fixed = true});
};

class Rectify {
 public:
  /// @param module  must outlive it.
  explicit Rectify(hc::Module& module);

 private:
  using Image = hc::MessageOf<hc::RgbImageKind<std::uint8_t>>;

  /// How the eyes are mounted; the default if unknown.
  struct Mounting {
    hc::gaze::HeadCalibration calibration;
    bool is_of_message = false;  ///< of the input `calibration`; else of the file
  };

  void start();
  void mount(const hc::MessageOf<hc::TableKind<double>>& message);
  void rectify(const Image& first, const Image& second);
  /// Makes the rectifier for an eye's images.
  void prepare(hc::vision::Eye eye, const hc::Header& header);
  hc::vision::StereoCalibration ideal_pair(const cv::Size& size);
  void send_intrinsics();
  void send_cameras();

  hc::Module& module_;
  hc::Input<hc::RgbImageKind<std::uint8_t>> left_ =
      module_.input("left", hc::rgb_image().in(hc::Coord::kLeftImage), "image of the left eye");
  hc::Input<hc::RgbImageKind<std::uint8_t>> right_ =
      module_.input("right", hc::rgb_image().in(hc::Coord::kRightImage), "image of the right eye");
  hc::Input<hc::TableKind<double>> head_ = module_.input(
      "calibration", hc::table(), "mounting of the eyes: calibrate's result", {.keep = 1});
  hc::Output<hc::RgbImageKind<std::uint8_t>> left_rectified_ = module_.output(
      "left", hc::rgb_image().in(hc::Coord::kLeftRectified), "rectified image of the left eye");
  hc::Output<hc::RgbImageKind<std::uint8_t>> right_rectified_ = module_.output(
      "right", hc::rgb_image().in(hc::Coord::kRightRectified), "rectified image of the right eye");
  hc::Output<hc::TableKind<double>> intrinsics_ =
      module_.output("intrinsics", hc::table().of(1, 5).in(hc::Coord::kLeftRectified),
                     "of the rectified pair, with the first image and then once a second",
                     {.columns = {"fx [px]", "fy [px]", "cx [px]", "cy [px]", "baseline [m]"}});
  hc::Output<hc::TransformationKind<double>> cameras_ = module_.output(
      "cameras", hc::transformation(),
      "with the intrinsics: T_head_left_eye as calibrated (coord 3004), and from the left camera "
      "of the rectified pair to the left eye (coord 4009)",
      {.on_demand = true});
  const RectifyParameters parameters_{module_};
  hc::ModuleFrames frames_{module_, {.input = false}};

  hc::vision::AssumedCameras assumed_{module_, "intrinsics have no true scale",
                                      "set calibration_file, or focal and frames"};
  std::optional<hc::vision::StereoCalibration> calibration_;
  std::optional<hc::vision::Rectifier> rectifiers_[2];
  Mounting mounting_;
  bool is_new_ = true;            // since the intrinsics were sent
  std::optional<hc::Time> time_;  // of the last image
};
