// SPDX-License-Identifier: Apache-2.0
#include "v4l2.h"

#include <algorithm>
#include <cmath>

#include <opencv2/videoio.hpp>

namespace {

// V4L2: exposure_absolute is in units of 100 µs; exposure_auto is 1 for manual, 0 for automatic,
// and 3 for automatic with a fixed iris, as in USB cameras.
constexpr double kExposureUnit = 1e-4, kManual = 1, kAuto = 0, kAutoTime = 3;

constexpr int kSilence = 2;  // [s]

int fourcc_of(const std::string& format) {
  return cv::VideoWriter::fourcc(format[0], format[1], format[2], format[3]);
}

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

hc::Result<std::vector<Setting>> settings_to_open(const CaptureMode& mode) {
  std::vector<Setting> settings;
  if (!mode.pixel_format.empty()) {
    if (mode.pixel_format.size() != 4)
      return hc::Error{hc::Code::Unsupported,
                       "pixel format " + mode.pixel_format + " is not a FourCC, e.g. MJPG"};
    settings.push_back(
        {cv::CAP_PROP_FOURCC, static_cast<double>(fourcc_of(mode.pixel_format)), ""});
  }
  // OpenCV ignores a width or height alone.
  if (mode.width > 0 && mode.height > 0) {
    settings.push_back({cv::CAP_PROP_FRAME_WIDTH, static_cast<double>(mode.width), ""});
    settings.push_back({cv::CAP_PROP_FRAME_HEIGHT, static_cast<double>(mode.height), ""});
  }
  if (mode.rate > 0) settings.push_back({cv::CAP_PROP_FPS, std::max(1.0, mode.rate), ""});
  return settings;
}

std::vector<Setting> settings_of(const Adjustment& adjustment, const Found& found) {
  std::vector<Setting> settings;
  if (adjustment.exposure > 0) {
    settings.push_back({cv::CAP_PROP_AUTO_EXPOSURE, kManual, ""});  // fails if always manual
    settings.push_back(
        {cv::CAP_PROP_EXPOSURE, adjustment.exposure / kExposureUnit, "exposure not supported"});
  } else {
    if (found.exposure > 0) settings.push_back({cv::CAP_PROP_EXPOSURE, found.exposure, ""});
    settings.push_back({cv::CAP_PROP_AUTO_EXPOSURE, kAuto, ""});
    settings.push_back({cv::CAP_PROP_AUTO_EXPOSURE, kAutoTime, ""});
  }
  if (adjustment.gain >= 0)
    settings.push_back({cv::CAP_PROP_GAIN, adjustment.gain, "gain not supported"});
  else if (found.gain >= 0)
    settings.push_back({cv::CAP_PROP_GAIN, found.gain, ""});
  return settings;
}

std::string difference(const CaptureMode& asked, int width, int height, double fourcc) {
  std::string text;
  if (asked.width > 0 && asked.height > 0 && (width != asked.width || height != asked.height))
    text = "gives " + size_text(width, height) + " pixels instead of " +
           size_text(asked.width, asked.height);
  if (asked.pixel_format.size() == 4 && static_cast<int>(fourcc) != fourcc_of(asked.pixel_format))
    text += std::string(text.empty() ? "gives" : ";") + " another pixel format than " +
            asked.pixel_format;
  return text;
}

int silence_of(const CaptureMode& mode) {
  if (mode.rate <= 0) return kSilence;
  return std::max(kSilence, static_cast<int>(std::ceil(std::min(2 / mode.rate, 3600.0))));
}
