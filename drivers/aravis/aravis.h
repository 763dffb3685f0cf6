// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cameras of the standards GigE Vision and USB3 Vision, by the library Aravis. No messages.
// A camera belongs to one thread; different ones may belong to different threads.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::aravis {

struct Image {
  cv::Mat bgr;            ///< (H, W, 3) u8: blue, green, red
  std::int64_t time = 0;  ///< when it came, by the wall clock [ns since the Unix epoch]
};

class Camera {
 public:
  /// Opens a camera and has it give images all the time.
  ///
  /// @param name  its name, serial number, network address; "" the first one; Fake_1 one that
  ///     Aravis itself makes up.
  /// @param pixel_format  as GenICam calls it, such as BayerRG8; "" as the camera is set, or where
  ///     that is none of Mono8, RGB8, BGR8 and 8-bit Bayer, one of these.
  ///
  /// @param rate  of images [1/s], where the camera can; 0: as it is set.
  ///
  /// Errors: NotFound (no such camera), Unsupported (the format), System (what Aravis says).
  /// Cost: blocks for some 10 ms, and for up to 3 s where no camera answers.
  static Result<std::unique_ptr<Camera>> open(const std::string& name,
                                              const std::string& pixel_format = "",
                                              double rate = 0);
  ~Camera();
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  /// Waits for the next image; incomplete ones are skipped.
  /// @returns  nothing when none came within `timeout`.
  ///
  /// Errors: Closed (the camera is lost: Aravis says so, or it has been silent for a second
  /// beyond its exposure and two periods of its rate, and two more at first; one that waits for a
  /// trigger may be silent), Malformed, Unsupported (what it sends).
  Result<std::optional<Image>> next(std::chrono::milliseconds timeout);

  /// Sets the time of exposure and ends the camera's own choice of it. [s]
  /// Errors: Unsupported (it has none, or not this one), System.
  Status set_exposure(double exposure);
  /// Sets the gain and ends the camera's own choice of it. [the camera's unit, mostly dB]
  Status set_gain(double gain);
  /// Lets the camera choose, all the time, if it can; else nothing is done.
  /// Errors: System.
  Status choose_exposure();
  Status choose_gain();                           ///< the same
  [[nodiscard]] Result<double> exposure() const;  ///< [s]
  [[nodiscard]] Result<double> gain() const;
  [[nodiscard]] Result<bool> chooses_exposure() const;  ///< whether it does now
  [[nodiscard]] Result<bool> chooses_gain() const;

 private:
  struct Handles;
  explicit Camera(std::unique_ptr<Handles> handles);
  std::unique_ptr<Handles> handles_;
};

}  // namespace hc::aravis
