// SPDX-License-Identifier: Apache-2.0
#include "devices.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include <drivers/aravis/aravis.h>
#include <hc/base/clock.h>
#include <opencv2/videoio.hpp>

#include "stream_clock.h"

namespace {

using namespace std::chrono_literals;

constexpr std::string_view kAravis = "aravis:";
constexpr int kStreamTimeout = 3000;  // of an RTSP server [ms]

bool is_number(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(),
                                      [](char each) { return each >= '0' && each <= '9'; });
}

class AravisDevice final : public Device {
 public:
  explicit AravisDevice(std::unique_ptr<hc::aravis::Camera> camera) : camera_(std::move(camera)) {}
  hc::Result<std::optional<Frame>> next(std::chrono::milliseconds timeout) override {
    auto image = HC_TRY(camera_->next(timeout));
    if (!image) return std::optional<Frame>();
    return std::optional<Frame>(Frame{image->bgr, image->time});
  }
  hc::Status adjust(const Adjustment& adjustment) override {
    auto exposure = adjustment.exposure > 0 ? camera_->set_exposure(adjustment.exposure)
                                            : camera_->choose_exposure();
    if (!exposure) return exposure;
    return adjustment.gain >= 0 ? camera_->set_gain(adjustment.gain) : camera_->choose_gain();
  }

 private:
  std::unique_ptr<hc::aravis::Camera> camera_;
};

/// A V4L2 device or an RTSP stream, read with OpenCV. Reading a silent source blocks for
/// silence_of() or kStreamTimeout.
class CaptureDevice final : public Device {
 public:
  CaptureDevice(cv::VideoCapture capture, bool is_device, std::string remark)
      : capture_(std::move(capture)),
        is_device_(is_device),
        found_{capture_.get(cv::CAP_PROP_EXPOSURE), capture_.get(cv::CAP_PROP_GAIN)},
        remark_(std::move(remark)) {}
  hc::Result<std::optional<Frame>> next(std::chrono::milliseconds) override {
    Frame frame;
    if (!capture_.read(frame.image)) return hc::Error{hc::Code::Closed, "no image received"};
    frame.time = time_of_image();
    return std::optional<Frame>(std::move(frame));
  }
  hc::Status adjust(const Adjustment& adjustment) override {
    for (const auto& setting : settings_of(adjustment, found_))
      if (!capture_.set(setting.property, setting.value) && !setting.refusal.empty())
        return hc::Error{hc::Code::Unsupported, setting.refusal};
    return {};
  }
  [[nodiscard]] std::string remark() const override { return remark_; }

 private:
  /// In wall time. V4L2 stamps images with the monotonic clock, a stream with its own.
  hc::Time time_of_image() {
    const hc::SystemClock clock;
    const auto now = clock.monotonic();
    auto taken = hc::duration(capture_.get(cv::CAP_PROP_POS_MSEC) / 1000);
    if (!is_device_) taken = stream_.time_of(taken, now);
    const auto age = now - taken;
    const bool is_known = taken > 0s && age >= 0s && (age < 1s || !is_device_);
    return is_known ? clock.wall() - age : clock.wall();
  }

  cv::VideoCapture capture_;
  bool is_device_;
  StreamClock stream_;
  Found found_;
  std::string remark_;
};

hc::Result<std::unique_ptr<Device>> open_capture(const std::string& name, const CaptureMode& mode) {
  cv::VideoCapture capture;
  const std::string path = is_number(name) ? "/dev/video" + name : name;
  const bool is_device = path.starts_with("/dev/");
  const bool is_open = is_device ? capture.open(path, cv::CAP_V4L2)
                                 : capture.open(path, cv::CAP_FFMPEG,
                                                {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, kStreamTimeout,
                                                 cv::CAP_PROP_READ_TIMEOUT_MSEC, kStreamTimeout});
  if (!is_open)
    return hc::Error{hc::Code::NotFound,
                     "cannot be opened as a camera" +
                         std::string(is_device ? "; hc doctor lists the cameras" : "")};
  std::string remark;
  if (is_device) {
    const auto settings = HC_TRY(settings_to_open(mode));
    for (const auto& setting : settings) capture.set(setting.property, setting.value);
    if (!capture.isOpened()) return hc::Error{hc::Code::Closed, "cannot be configured"};
    remark = difference(mode, cvRound(capture.get(cv::CAP_PROP_FRAME_WIDTH)),
                        cvRound(capture.get(cv::CAP_PROP_FRAME_HEIGHT)),
                        capture.get(cv::CAP_PROP_FOURCC));
  }
  return std::unique_ptr<Device>(
      std::make_unique<CaptureDevice>(std::move(capture), is_device, std::move(remark)));
}

}  // namespace

bool is_live(const std::string& name) {
  if (name.find('!') != std::string::npos) return false;  // a pipeline
  return name.starts_with(kAravis) || is_number(name) || name.starts_with("/dev/") ||
         name.starts_with("rtsp://");
}

LiveCamera live_camera(const std::string& name, const CaptureMode& mode) {
  // OpenCV has no property for this timeout and reads the variable once, before the first image.
  // setenv() is safe here, since no camera thread runs yet.
  ::setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", std::to_string(silence_of(mode)).c_str(), 0);
  if (!name.starts_with(kAravis)) return {name, [=] { return open_capture(name, mode); }};
  return {name,
          [device = name.substr(kAravis.size()), mode]() -> hc::Result<std::unique_ptr<Device>> {
            auto camera = HC_TRY(hc::aravis::Camera::open(device, mode.pixel_format, mode.rate));
            return std::unique_ptr<Device>(std::make_unique<AravisDevice>(std::move(camera)));
          }};
}
