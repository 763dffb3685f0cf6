// SPDX-License-Identifier: Apache-2.0
// One camera, or the two of a stereo pair.
#include "camera.h"
#include "devices.h"

#include <hc/module/module.h>
#include <vision/messages.h>
#include <vision/picture.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>

namespace {

constexpr std::int32_t kLeftImage = 7, kRightImage = 8, kLeftRectified = 9, kRightRectified = 10;
constexpr std::chrono::milliseconds kPatience{20};  // until commands are looked for again

}  // namespace

int main(int argc, char** argv) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // it says so in results
  hc::Module module{"camera", "Gives the pictures of a camera, a video or picture files."};
  auto left = module.output("left", hc::rgb_image<std::uint8_t>(), "picture of the left eye");
  auto right = module.output("right", hc::rgb_image<std::uint8_t>(), "picture of the right eye");
  auto left_name = module.parameter(
      "source", "0", "",
      "aravis:NAME, device, video, pipeline, folder or picture of the left or only eye",
      {.positional = true});
  auto right_name =
      module.parameter("right_source", "", "", "the same of the right eye", {.positional = true});
  auto side_by_side = module.parameter("side_by_side", false, "",
                                       "each picture holds both eyes', the left one on the left");
  auto width = module.parameter("width", 0, "px",
                                "width to scale and cut to, 0: as it comes; with the height also "
                                "what a V4L2 device is opened with",
                                {.min = 0, .max = 65535});
  auto height = module.parameter("height", 0, "px", "height to scale and cut to, 0: as it comes",
                                 {.min = 0, .max = 65535});
  auto smooth =
      module.parameter("smooth", true, "", "mix pixels when scaling; false takes the nearest");
  auto rectified = module.parameter("rectified", false, "", "the pictures are rectified already");
  auto stamped = module.parameter("stamped", true, "", "give the pictures a time");
  auto rate = module.parameter("rate", 0.0, "Hz",
                               "pictures a second, 0: as they come; a camera is asked for it",
                               {.min = 0, .max = 1e4});
  auto count = module.parameter("count", 0, "", "pictures to give, 0: all", {.min = 0});
  auto loop = module.parameter("loop", false, "", "begin again at the end");

  auto reopen = module.parameter(
      "reopen", true, "", "try again when a camera is lost: aravis, device, rtsp", {.fixed = true});
  auto exposure = module.parameter("exposure", 0.0, "s",
                                   "of a camera, 0: its own choice, automatic if it has that",
                                   {.min = 0, .max = 100});
  auto gain =
      module.parameter("gain", -1.0, "", "in the camera's unit, mostly dB; -1: its own choice",
                       {.min = -1, .max = 1e4});
  auto pixel_format = module.parameter(
      "pixel_format", "", "",
      "of aravis, as BayerRG8, RGB8, Mono8; of V4L2 a FourCC, as MJPG; empty: the camera's",
      {.fixed = true});

  std::unique_ptr<PictureSource> left_source, right_source;
  std::unique_ptr<LiveCameras> cameras;
  Adjustment adjustment;
  auto adjust = [&] {
    const Adjustment wanted{*exposure, *gain};
    if (wanted != adjustment && cameras != nullptr) cameras->adjust(wanted);
    adjustment = wanted;
  };
  module.on_start([&] {
    if (is_live(*left_name) && (right_name->empty() || is_live(*right_name))) {
      if (!right_name->empty() && *side_by_side)
        throw hc::ModuleError("side_by_side and right_source do not go together");
      adjust();
      const CaptureMode mode{static_cast<int>(*width) * (*side_by_side ? 2 : 1),
                             static_cast<int>(*height), *rate, *pixel_format};
      std::vector<LiveCamera> live{live_camera(*left_name, mode)};
      if (!right_name->empty()) live.push_back(live_camera(*right_name, mode));
      cameras = std::make_unique<LiveCameras>(std::move(live), *reopen, adjustment);
      return;
    }
    for (const auto* name : {&*left_name, &*right_name})
      if (name->starts_with("aravis:"))
        throw hc::ModuleError(*name + " does not go together with a file");
    left_source = open_picture_source(*left_name);
    if (!right_name->empty()) right_source = open_picture_source(*right_name);
    if (right_source != nullptr && *side_by_side)
      throw hc::ModuleError("side_by_side and right_source do not go together");
  });

  auto next = [&](PictureSource& source) {
    cv::Mat picture = source.next();
    if (picture.empty() && *loop && source.rewind()) picture = source.next();
    return picture;
  };
  auto send = [&](auto& output, const cv::Mat& picture, std::int64_t time, std::int32_t coord) {
    cv::Mat fitted =
        hc::vision::fit(picture, static_cast<int>(*width), static_cast<int>(*height), *smooth);
    auto draft = output.loan(fitted.cols, fitted.rows);
    draft.header.time = time;
    draft.header.coord = coord;
    cv::Mat rgb = hc::as_mat(draft);
    cv::cvtColor(fitted, rgb, cv::COLOR_BGR2RGB);
    output.send(std::move(draft));
  };

  std::int64_t given = 0;
  auto send_all = [&](cv::Mat left_picture, cv::Mat right_picture, std::int64_t time) {
    if (*side_by_side) {
      int half = left_picture.cols / 2;
      right_picture = left_picture.colRange(half, 2 * half);
      left_picture = left_picture.colRange(0, half);
    }
    if (!left_picture.empty())
      send(left, left_picture, time, *rectified ? kLeftRectified : kLeftImage);
    if (!right_picture.empty())
      send(right, right_picture, time, *rectified ? kRightRectified : kRightImage);
    ++given;
  };
  Thinning thinning;
  auto take_live = [&] {
    adjust();
    auto taken = cameras->next(kPatience);
    for (const auto& line : cameras->remarks()) module.log(line);
    if (!taken) throw hc::ModuleError(taken.error().detail);
    if (!*taken) return;
    const auto& [left_frame, right_frame] = **taken;
    // A pair has one time, as who takes both together expects.
    const std::int64_t time = left_frame ? left_frame->time : right_frame->time;
    if (!thinning.takes(time, *rate)) return;
    send_all(left_frame ? left_frame->picture : cv::Mat(),
             right_frame ? right_frame->picture : cv::Mat(), *stamped ? time : 0);
  };
  module.generate([&] {
    if (*count > 0 && given == *count) return false;
    if (*rate > 0 && cameras == nullptr) module.keep_rate(*rate);
    if (cameras != nullptr) {
      take_live();
      return true;
    }
    cv::Mat left_picture = next(*left_source), right_picture;
    std::int64_t time = *stamped ? module.now() : 0;
    if (right_source != nullptr) right_picture = next(*right_source);
    if (left_picture.empty() || (right_source != nullptr && right_picture.empty())) return false;
    send_all(left_picture, right_picture, time);
    return true;
  });
  return module.run(argc, argv);
}
