// SPDX-License-Identifier: Apache-2.0
#pragma once
// GigE Vision and USB3 Vision cameras, with the library Aravis. No messages. A camera is for one
// thread; different cameras may be used on different threads.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <hc/base/result.h>
#include <hc/base/time.h>
#include <opencv2/core.hpp>

namespace hc::aravis {

struct Image {
  cv::Mat bgr;  ///< (H, W, 3) u8: blue, green, red
  Time time;    ///< of arrival
};

class Camera {
 public:
  /// Opens a camera and starts continuous acquisition.
  ///
  /// @param name  name, serial number or network address; "": the first; Fake_1: simulated.
  /// @param pixel_format  GenICam name, such as BayerRG8; "": the camera's setting if supported,
  ///     else one of Mono8, RGB8, BGR8 and 8-bit Bayer.
  /// @param rate  of images, if the camera supports it; 0: the camera's setting [Hz].
  ///
  /// Errors: NotFound (no such camera), Unsupported (the format), System (from Aravis).
  /// Cost: blocks for some 10 ms, or up to 3 s if no camera answers.
  static Result<std::unique_ptr<Camera>> open(const std::string& name,
                                              const std::string& pixel_format = "",
                                              double rate = 0);
  ~Camera();
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  /// Waits for the next image; skips incomplete ones.
  /// @returns  nothing on timeout.
  ///
  /// Errors: Closed (the camera is lost: reported by Aravis, or silent for 1 s plus its exposure
  /// and two periods, plus 2 s for the first image; a triggered camera may be silent), Malformed,
  /// Unsupported (its images).
  Result<std::optional<Image>> next(std::chrono::milliseconds timeout);

  /// Sets the exposure time and turns off automatic exposure [s].
  /// Errors: Unsupported (no such feature, or out of range), System.
  Status set_exposure(double exposure);
  /// Sets the gain and turns off automatic gain [the camera's unit, mostly dB].
  Status set_gain(double gain);
  /// Turns on automatic exposure or gain, if supported.
  /// Errors: System.
  Status choose_exposure();
  Status choose_gain();
  [[nodiscard]] Result<double> exposure() const;  ///< [s]
  [[nodiscard]] Result<double> gain() const;
  [[nodiscard]] Result<bool> chooses_exposure() const;  ///< automatic exposure is on
  [[nodiscard]] Result<bool> chooses_gain() const;

 private:
  struct Handles;
  explicit Camera(std::unique_ptr<Handles> handles);
  std::unique_ptr<Handles> handles_;
};

}  // namespace hc::aravis
