// SPDX-License-Identifier: Apache-2.0
// Sends the images of one camera or of a stereo pair.
#include "devices.h"
#include "sequence.h"

#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/image.h>
#include <vision/messages.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>

namespace {

constexpr std::chrono::milliseconds kTimeout{20};  // maximum delay of commands

void check(bool is_valid, const std::string& problem) {
  if (!is_valid) throw hc::ModuleError(hc::Error{hc::Code::Invalid, problem});
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  using hc::Coord;
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // we log errors ourselves
  hc::Module module{"camera", "Sends the images of a camera, a video or image files."};
  auto left = module.output("left", hc::rgb_image(), "image of the left eye");
  auto right = module.output("right", hc::rgb_image(), "image of the right eye");
  auto left_name = module.parameter("source", "", "",
                                    "left or only eye: aravis:NAME, a number or /dev/videoN, "
                                    "rtsp://…, a video, pipeline, folder or image",
                                    {.positional = true, .fixed = true});
  auto right_name = module.parameter("right_source", "", "", "the same of the right eye",
                                     {.positional = true, .fixed = true});
  auto side_by_side = module.parameter("side_by_side", false, "",
                                       "each image holds both eyes', the left one on the left");
  auto width = module.parameter("width", 0, "px",
                                "width to scale and crop to, 0: native; with the height also what "
                                "a V4L2 device is opened with",
                                {.min = 0, .max = 65535});
  auto height = module.parameter("height", 0, "px", "height to scale and crop to, 0: native",
                                 {.min = 0, .max = 65535});
  auto smooth =
      module.parameter("smooth", true, "", "interpolate when scaling; false takes the nearest");
  auto rectified = module.parameter("rectified", false, "", "the images are rectified already");
  auto stamped = module.parameter("stamped", true, "", "give the images a time");
  auto rate =
      module.parameter("rate", 0.0, "Hz", "images a second, 0: native; a camera is asked for it",
                       {.min = 0, .max = 1e4});
  auto count = module.parameter("count", 0, "", "images to send, 0: all", {.min = 0});
  auto loop = module.parameter("loop", false, "", "start again at the end");
  auto reopen =
      module.parameter("reopen", true, "", "reconnect when a camera is lost", {.fixed = true});
  auto exposure =
      module.parameter("exposure", 0.0, "s", "of a camera, 0: automatic, or the camera's default",
                       {.min = 0, .max = 100});
  auto gain = module.parameter("gain", -1.0, "",
                               "in the camera's unit, mostly dB; -1: the camera's default",
                               {.min = -1, .max = 1e4});
  auto pixel_format = module.parameter(
      "pixel_format", "", "",
      "of aravis, e.g. BayerRG8, RGB8, Mono8; of V4L2 a FourCC, e.g. MJPG; empty: the camera's",
      {.fixed = true});

  std::unique_ptr<ImageSequence> left_file, right_file;
  std::unique_ptr<LiveCameras> cameras;
  Thinning thinning;
  std::int64_t sent = 0;

  module.on_start([&] {
    check(!left_name->empty(),
          "no source given: a camera's number, /dev/videoN or aravis:, a video, a folder or an "
          "image; see --help");
    check(right_name->empty() || !*side_by_side,
          "side_by_side and right_source exclude each other");
    check(right_name->empty() || is_live(*left_name) == is_live(*right_name),
          "a camera and a file cannot be the two eyes");
    if (!is_live(*left_name)) {
      left_file = open_sequence(*left_name);
      if (!right_name->empty()) right_file = open_sequence(*right_name);
      return;
    }
    const CaptureMode mode{static_cast<int>(*width) * (*side_by_side ? 2 : 1),
                           static_cast<int>(*height), *rate, *pixel_format};
    std::vector<LiveCamera> live{live_camera(*left_name, mode)};
    if (!right_name->empty()) live.push_back(live_camera(*right_name, mode));
    cameras = std::make_unique<LiveCameras>(std::move(live), *reopen, Adjustment{*exposure, *gain});
  });

  auto send = [&](auto& output, const cv::Mat& image, std::int64_t time, std::int32_t coord) {
    if (image.empty()) return;
    const cv::Mat fitted =
        hc::vision::fit(image, static_cast<int>(*width), static_cast<int>(*height), *smooth);
    auto draft = output.loan(fitted.rows, fitted.cols);
    draft.header.time = *stamped ? time : 0;
    draft.header.coord = coord;
    hc::fill(draft, [&](cv::Mat& rgb) { cv::cvtColor(fitted, rgb, cv::COLOR_BGR2RGB); });
    output.send(std::move(draft));
  };
  auto send_both = [&](cv::Mat left_image, cv::Mat right_image, std::int64_t time) {
    if (*side_by_side) {
      const int half = left_image.cols / 2;
      right_image = left_image.colRange(half, 2 * half);
      left_image = left_image.colRange(0, half);
    }
    send(left, left_image, time, *rectified ? Coord::kLeftRectified : Coord::kLeftImage);
    send(right, right_image, time, *rectified ? Coord::kRightRectified : Coord::kRightImage);
    ++sent;
  };
  auto take_live = [&] {
    cameras->adjust({*exposure, *gain});
    auto taken = cameras->next(kTimeout);
    for (const auto& [level, line] : cameras->remarks()) module.log(line, level);
    if (!taken) throw hc::ModuleError(taken.error().detail);
    if (!*taken) return;
    const auto& [left_frame, right_frame] = **taken;
    // Both images of a pair get the same time, so that they match downstream.
    const std::int64_t time = left_frame ? left_frame->time : right_frame->time;
    if (thinning.takes(time, *rate))
      send_both(left_frame ? left_frame->image : cv::Mat(),
                right_frame ? right_frame->image : cv::Mat(), time);
  };
  auto next = [&](ImageSequence& file) {
    cv::Mat image = file.next();
    if (!image.empty() || !*loop) return image;
    file.rewind();
    return file.next();
  };
  module.generate([&] {
    if (*count > 0 && sent == *count) return module.stop();
    if (cameras != nullptr) return take_live();
    if (*rate > 0) module.keep_rate(*rate);
    const cv::Mat left_image = next(*left_file);
    const std::int64_t time = module.now();
    const cv::Mat right_image = right_file ? next(*right_file) : cv::Mat();
    if (left_image.empty() || (right_file && right_image.empty())) return module.stop();
    send_both(left_image, right_image, time);
  });
  return module.run(argc, argv);
}
