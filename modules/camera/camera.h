// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sends the images of one camera or of a stereo pair.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <hc/module/module.h>
#include <opencv2/core.hpp>

#include "live.h"
#include "pairing.h"
#include "sequence.h"

struct CameraParameters {
  hc::Module& module;

  hc::Parameter<std::string> source =
      module.parameter("source", "", "",
                       "left or only eye: aravis:NAME, a number or /dev/videoN, "
                       "rtsp://…, a video, pipeline, folder or image",
                       {.positional = true, .fixed = true});
  hc::Parameter<std::string> right_source = module.parameter(
      "right_source", "", "", "the same of the right eye", {.positional = true, .fixed = true});
  hc::Parameter<bool> side_by_side = module.parameter(
      "side_by_side", false, "", "each image holds both eyes', the left one on the left");
  hc::Parameter<std::int64_t> width =
      module.parameter("width", 0, "px",
                       "width to scale and crop to, 0: native; with the height also what "
                       "a V4L2 device is opened with",
                       {.min = 0, .max = 65535});
  hc::Parameter<std::int64_t> height = module.parameter(
      "height", 0, "px", "height to scale and crop to, 0: native", {.min = 0, .max = 65535});
  hc::Parameter<bool> smooth =
      module.parameter("smooth", true, "", "interpolate when scaling; false takes the nearest");
  hc::Parameter<bool> rectified =
      module.parameter("rectified", false, "", "the images are rectified already");
  hc::Parameter<bool> upright =
      module.parameter("upright", true, "",
                       "turn image and video files as their EXIF data says; never those of two "
                       "eyes, or rectified ones",
                       {.fixed = true});
  hc::Parameter<bool> stamped = module.parameter("stamped", true, "", "give the images a time");
  hc::Parameter<double> rate =
      module.parameter("rate", 0.0, "Hz",
                       "images a second, 0: native, of image files as fast as possible; a camera "
                       "is asked for it, a video is thinned out to it",
                       {.min = 0, .max = 1e4});
  hc::Parameter<bool> paced =
      module.parameter("paced", true, "",
                       "a video in real time; false: as fast as it is read, with the same times "
                       "from the start on");
  hc::Parameter<std::int64_t> count =
      module.parameter("count", 0, "", "images to send, 0: all", {.min = 0});
  hc::Parameter<bool> loop = module.parameter("loop", false, "", "start again at the end");
  hc::Parameter<bool> reopen =
      module.parameter("reopen", true, "", "reconnect when a camera is lost", {.fixed = true});
  hc::Parameter<double> exposure =
      module.parameter("exposure", 0.0, "s", "of a camera, 0: automatic, or the camera's default",
                       {.min = 0, .max = 100});
  hc::Parameter<double> gain = module.parameter(
      "gain", -1.0, "", "in the camera's unit, mostly dB; -1: the camera's default",
      {.min = -1, .max = 1e4});
  hc::Parameter<std::string> pixel_format = module.parameter(
      "pixel_format", "", "",
      "of aravis, e.g. BayerRG8, RGB8, Mono8; of V4L2 a FourCC, e.g. MJPG; empty: the camera's",
      {.fixed = true});

  [[nodiscard]] bool is_pair() const { return !right_source->empty(); }
  /// A calibration is of the images as the sensor has them.
  [[nodiscard]] bool is_upright() const {
    return *upright && !is_pair() && !*side_by_side && !*rectified;
  }
  /// Ends the module where parameters exclude each other.
  void check() const;
};

class Camera {
 public:
  /// @param module  must outlive it.
  explicit Camera(hc::Module& module);

 private:
  using Images = hc::Output<hc::RgbImageKind<std::uint8_t>>;

  /// When a video began to play, now or again, by both clocks.
  struct Start {
    hc::Time time;
    hc::MonotonicTime monotonic;
  };

  void start();
  void open_live();
  void generate();
  void take_live();
  void take_files();
  void take_video();
  [[nodiscard]] SequenceImage next(ImageSequence& file) const;
  std::optional<std::array<Frame, 2>> next_of_video();
  void start_video_again();
  void send_both(cv::Mat left, cv::Mat right, hc::Time time);
  void send(Images& output, const cv::Mat& image, hc::Time time, std::int32_t coord);

  hc::Module& module_;
  hc::Output<hc::RgbImageKind<std::uint8_t>> left_ =
      module_.output("left", hc::rgb_image(), "image of the left eye");
  hc::Output<hc::RgbImageKind<std::uint8_t>> right_ =
      module_.output("right", hc::rgb_image(), "image of the right eye");
  const CameraParameters parameters_{module_};

  SequencePair files_;
  std::optional<Start> start_;     // of a video
  std::optional<hc::Time> shown_;  // time of the last image read
  Pairing pairing_;                // of two videos
  std::array<hc::Time, 2> last_;
  std::unique_ptr<LiveCameras> cameras_;  // instead of files
  Thinning thinning_;
  std::int64_t sent_ = 0;
};
