// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cameras that send images by themselves, and may be disconnected. Each is opened, waited for and
// reopened on a thread of its own, so that it holds up nothing else.

#include <array>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <hc/base/backoff.h>
#include <hc/base/clock.h>
#include <hc/base/log.h>
#include <hc/base/result.h>

#include "pairing.h"

/// What can be set while a camera runs.
struct Adjustment {
  double exposure = 0;  ///< [s]; 0: the camera's own choice
  double gain = -1;     ///< in the camera's unit; less than 0: the camera's own choice
  bool operator==(const Adjustment&) const = default;
};

/// Thins out images to a rate, by their times, without holding any back. Pure.
class Thinning {
 public:
  /// Whether an image of such a time [ns] is taken at a rate [1/s]; 0: all are.
  bool takes(std::int64_t time, double rate);

 private:
  double due_ = 0;  // of the next one [ns]
};

/// An open camera, which belongs to one thread.
class Device {
 public:
  virtual ~Device() = default;
  /// Waits for an image; nothing when none comes in time. Errors: any, the camera is lost.
  virtual hc::Result<std::optional<Frame>> next(std::chrono::milliseconds timeout) = 0;
  virtual hc::Status adjust(const Adjustment& adjustment) = 0;
  /// How it differs from what was asked for when it was opened; "": not.
  [[nodiscard]] virtual std::string remark() const { return {}; }
};

/// Opens a camera; is called on its thread, again and again while it fails.
using OpenDevice = std::function<hc::Result<std::unique_ptr<Device>>()>;

/// A line of the log about a camera.
struct Remark {
  hc::Level level = hc::Level::Warning;
  std::string text;
  bool operator==(const Remark&) const = default;
};

struct LiveCamera {
  std::string name;  ///< as remarks call it
  OpenDevice open;
};

/// One camera, or two whose images are taken in pairs at nearest times. When one of two is lost
/// the other continues alone.
class LiveCameras {
 public:
  struct Taken {
    std::optional<Frame> left, right;
  };

  /// @param reopen  try again when a camera is lost or was never there; otherwise next() fails.
  LiveCameras(std::vector<LiveCamera> cameras, bool reopen, const Adjustment& adjustment);
  ~LiveCameras();
  LiveCameras(const LiveCameras&) = delete;
  LiveCameras& operator=(const LiveCameras&) = delete;

  /// Waits for an image or pair; the newest where several have come. Nothing when none has.
  /// Errors: without `reopen`, those of a camera.
  hc::Result<std::optional<Taken>> next(std::chrono::milliseconds timeout);
  /// Sets what the cameras are to do from now on. The same again changes nothing.
  void adjust(const Adjustment& adjustment);
  /// One for each change.
  std::vector<Remark> remarks();

 private:
  struct Camera;
  void run(Camera& camera);
  void serve(Camera& camera, Device& device);
  void miss(Camera& camera, const hc::Error& why, const char* how, const char* then);
  void report(std::string text);
  bool pause(std::chrono::nanoseconds time);

  const bool reopen_;
  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  bool stopping_ = false;
  Adjustment adjustment_;
  std::vector<Remark> remarks_;
  std::optional<hc::Error> failure_;
  Pairing pairing_;
  std::vector<std::unique_ptr<Camera>> cameras_;
};
