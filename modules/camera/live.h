// SPDX-License-Identifier: Apache-2.0
#pragma once
// Live cameras, which may disconnect. Each is opened, read and reopened on a separate thread, so
// that it delays nothing else.

#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
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

/// Settings that can change while a camera runs.
struct Adjustment {
  double exposure = 0;  ///< [s]; 0: automatic
  double gain = -1;     ///< in the camera's unit; < 0: automatic
  bool operator==(const Adjustment&) const = default;
};

/// Thins out images to a rate, by their times; never delays one. Pure.
class Thinning {
 public:
  /// Whether to take the image of this time at a rate [1/s]; 0: all.
  bool takes(hc::Time time, double rate);

 private:
  hc::Time due_;  // next image
};

/// An open camera. For one thread.
class Device {
 public:
  virtual ~Device() = default;
  /// Waits for an image; nothing on timeout. Errors: any means that the camera is lost.
  virtual hc::Result<std::optional<Frame>> next(std::chrono::milliseconds timeout) = 0;
  virtual hc::Status adjust(const Adjustment& adjustment) = 0;
  /// How the mode differs from the requested one; "" if it does not.
  [[nodiscard]] virtual std::string remark() const { return {}; }
};

/// Opens a camera. Called on its thread, and again after a failure.
using OpenDevice = std::function<hc::Result<std::unique_ptr<Device>>()>;

/// A line of the log about a camera.
struct Remark {
  hc::Level level = hc::Level::Warning;
  std::string text;
  bool operator==(const Remark&) const = default;
};

struct LiveCamera {
  std::string name;  ///< in remarks
  OpenDevice open;
};

/// One camera, or two whose images are paired by time. If one is lost, the other continues alone.
class LiveCameras {
 public:
  struct Taken {
    std::optional<Frame> left, right;
  };

  /// @param reopen  retry when a camera is lost or missing; otherwise next() fails.
  LiveCameras(std::vector<LiveCamera> cameras, bool reopen, const Adjustment& adjustment);
  ~LiveCameras();
  LiveCameras(const LiveCameras&) = delete;
  LiveCameras& operator=(const LiveCameras&) = delete;

  /// Waits for the next image or pair; nothing on timeout. Images are dropped for a slow reader,
  /// but not those of a burst. Errors: without `reopen`, those of a camera.
  hc::Result<std::optional<Taken>> next(std::chrono::milliseconds timeout);
  /// Applies settings to all cameras, if they changed.
  void adjust(const Adjustment& adjustment);
  /// Takes the remarks since the last call.
  std::vector<Remark> remarks();

 private:
  struct Camera;
  void run(Camera& camera);
  void serve(Camera& camera, Device& device);
  void take_pairs();
  void miss(Camera& camera, const hc::Error& why, const char* how, const char* then);
  void report(std::string text);
  bool pause(std::chrono::nanoseconds time);

  const bool reopen_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  bool stopping_ = false;
  Adjustment adjustment_;
  std::vector<Remark> remarks_;
  std::optional<hc::Error> failure_;
  Pairing pairing_;
  bool is_starving_ = false;  // there are no pairs, and this was logged
  std::deque<Taken> taken_;   // for next()
  // When next() last took all.
  std::chrono::steady_clock::time_point kept_up_ = std::chrono::steady_clock::now();
  std::vector<std::unique_ptr<Camera>> cameras_;
};
