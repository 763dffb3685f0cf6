// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shows images in a window and saves them as PNG files.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <hc/module/module.h>
#include <vision/window.h>
#include <opencv2/core.hpp>

#include "saver.h"

struct ViewParameters {
  hc::Module& module;

  hc::Parameter<std::string> save =
      module.parameter("save", "", "",
                       "PNG file for the latest image, replaced once a second and at the "
                       "end, or folder/ for all as SRC_SEQ.png",
                       {.positional = true});
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
  hc::Parameter<bool> relief = module.parameter("relief", false, "", "shade depth as a relief");
  hc::Parameter<bool> legend =
      module.parameter("legend", true, "", "a scale beside images in colours");
  hc::Parameter<double> min =
      module.parameter("min", 0.0, "", "lower end of the colour scale; both 0: from the image");
  hc::Parameter<double> max =
      module.parameter("max", 0.0, "", "upper end of the colour scale; both 0: from the image");
  hc::Parameter<std::int64_t> count =
      module.parameter("count", 0, "", "end after this number of images, 0: never", {.min = 0});

  static std::vector<std::string> layouts();
};

class ImageView {
 public:
  /// @param module  must outlive it.
  explicit ImageView(hc::Module& module);

  /// Logs where the last image was saved.
  /// @param status  of run(). @returns  that of the program.
  [[nodiscard]] int finish(int status) const;

 private:
  /// Images of both eyes at the same time.
  struct Eyes {
    hc::Header header;
    cv::Mat left, right;
  };

  void start();
  void take(const hc::Message& message);
  void join(const hc::Header& header, const cv::Mat& bgr);
  void show(const hc::Header& header, const cv::Mat& bgr);
  void end();
  /// An image in blue, green, red, or grey.
  [[nodiscard]] cv::Mat visible(const hc::Header& header, const cv::Mat& values) const;

  hc::Module& module_;
  hc::Input<hc::AnyKind> image_ =
      module_.input("image",
                    hc::any_of(hc::rgb_image(), hc::intensity_image(),
                               hc::intensity_image<std::uint16_t>(), hc::intensity_image<float>()),
                    "an image; other than u8 in colours, blue for small values");
  const ViewParameters parameters_{module_};

  std::unique_ptr<hc::vision::Display> display_;
  Saver saver_{module_};
  int seen_ = 0;
  Eyes eyes_;
};
