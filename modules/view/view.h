// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shows images in a window and saves them as PNG files.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hc/module/module.h>
#include <vision/window.h>
#include <opencv2/core.hpp>

#include "eye_sets.h"
#include "saver.h"

struct ViewParameters {
  hc::Module& module;

  hc::Parameter<std::string> save =
      module.parameter("save", "", "",
                       "PNG file for the latest image, replaced once a second and at the "
                       "end, or folder/ for all as SRC_SEQ.png");
  hc::Parameter<std::string> window = module.parameter(
      "window", "auto", "", "show a window", {.choices = {"auto", "yes", "no"}, .fixed = true});
  hc::Parameter<std::int64_t> monitor =
      module.parameter("monitor", -1, "", "monitor for full screen, from 0; -1: windows",
                       {.min = -1, .max = 15, .fixed = true});
  hc::Parameter<bool> stay = module.parameter(
      "stay", true, "", "keep windows after the last image, until a key is pressed");
  hc::Parameter<std::string> stereo = module.parameter(
      "stereo", "none", "", "how the images of both eyes (by coordinate system) become one",
      {.choices = layouts()});
  hc::Parameter<std::string> coding =
      module.parameter("coding", "colours", "",
                       "how depth is shown: in false colours, these shaded as a relief, or as fog "
                       "in the image of the eye, which is linked too",
                       {.choices = codings()});
  hc::Parameter<bool> legend =
      module.parameter("legend", true, "", "a scale beside images in colours");
  hc::Parameter<double> min =
      module.parameter("min", 0.0, "", "lower end of the colour scale; both 0: from the image");
  hc::Parameter<double> max =
      module.parameter("max", 0.0, "", "upper end of the colour scale; both 0: from the image");
  hc::Parameter<std::int64_t> count =
      module.parameter("count", 0, "", "end after this number of images, 0: never", {.min = 0});

  static std::vector<std::string> layouts();
  static std::vector<std::string> codings();
};

class ImageView {
 public:
  /// @param module  must outlive it.
  explicit ImageView(hc::Module& module);

  /// Logs where the last image was saved.
  /// @param status  of run(). @returns  that of the program.
  [[nodiscard]] int finish(int status) const;

 private:
  void start();
  void take(const hc::Message& message);
  /// @param set  see EyeSets::Take.
  void take_set(std::span<const hc::Message> set);
  /// The images of the eyes as one; empty if they do not fit.
  [[nodiscard]] cv::Mat join(std::span<cv::Mat> eyes);
  void log_missing(bool is_end);
  void show(const hc::Header& header, const cv::Mat& bgr);
  void end();
  /// Images in blue, green, red, or grey, on one scale.
  /// @param images  of the eyes, for fog.
  [[nodiscard]] std::vector<cv::Mat> visible(std::span<const hc::Message> shown,
                                             std::span<const hc::Message> images) const;

  hc::Module& module_;
  hc::Input<hc::AnyKind> image_ = module_.input(
      "image",
      hc::any_of(hc::rgb_image(), hc::intensity_image(), hc::intensity_image<std::uint16_t>(),
                 hc::intensity_image<float>()),
      "images, also of both eyes; other than u8 as `coding` says, blue for small values");
  const ViewParameters parameters_{module_};

  std::unique_ptr<hc::vision::Display> display_;
  Saver saver_{module_};
  int seen_ = 0;
  std::unique_ptr<EyeSets> eyes_;
};
