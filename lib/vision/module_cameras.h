// SPDX-License-Identifier: Apache-2.0
#pragma once
// The cameras that a module computes with: those that are linked or set, else assumed ones, and
// the log says so.

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <hc/module/module.h>

namespace hc::vision {

/// The value of a parameter `focal` that is not known.
inline constexpr double kUnknownFocal = 0;

/// Says in the log, once, what a module assumes of its cameras.
class AssumedCameras {
 public:
  /// @param wrong  what the assumption spoils: "depths have no true scale".
  /// @param remedy  "link intrinsics, or set focal and baseline"
  AssumedCameras(Module& module, std::string wrong, std::string remedy)
      : module_(module), wrong_(std::move(wrong)), remedy_(std::move(remedy)) {}

  /// A focal length; if it is kUnknownFocal, the image's width, a field of view of 53° [px].
  /// @param baseline  distance of the eyes, where that is assumed too [m].
  double focal(double known, int width, std::optional<double> baseline = std::nullopt);
  /// Says that `what` is assumed.
  void say(const std::string& what);

 private:
  Module& module_;
  std::string wrong_, remedy_;
  bool has_said_ = false;
};

/// A rectified pair: two equal cameras without distortion, side by side.
struct PairIntrinsics {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
  double baseline = 0;                    ///< [m]

  /// Takes fx, fy, cx, cy [px], baseline [m]; nothing if they are invalid.
  static std::optional<PairIntrinsics> of(std::span<const double> numbers);
};

/// The rectified pair whose images a module gets, by its input `intrinsics`; where that has no
/// link, by the parameters `focal` and `baseline`; and where these are not set, an assumed one.
class ModulePair {
 public:
  /// Declares the input and the parameters. Must outlive run().
  /// @param wrong  see AssumedCameras.
  ModulePair(Module& module, ModuleFrames& frames, std::string wrong);
  ModulePair(const ModulePair&) = delete;
  ModulePair& operator=(const ModulePair&) = delete;

  /// Whether the intrinsics are still to come by their link.
  [[nodiscard]] bool is_awaited() const { return !linked_ && intrinsics_.linked(); }
  /// Calls a handler once the pair is known: at once, or between messages, in order. Messages sent
  /// by a handler need a time, since no message of the pair is being handled. If more than 4 wait,
  /// the oldest is dropped, and the log says so.
  void when_known(std::function<void()> handler);
  /// Calls the waiting handlers, with an assumed pair; for the end, when no more messages arrive.
  void answer_all();
  /// The pair of which an image is. @param width, height  of the image [px].
  PairIntrinsics of(int width, int height);

 private:
  Module& module_;
  ModuleFrames& frames_;
  Input<TableKind<double>> intrinsics_;
  Parameter<double> focal_, baseline_;
  AssumedCameras assumed_;
  std::optional<PairIntrinsics> linked_;
  std::deque<std::function<void()>> waiting_;
};

/// How the left rectified camera is mounted: as the messages `cameras` of rectify say, and until
/// they do as the graph's frames do.
class RectifiedMount {
 public:
  /// Takes T_head_left_eye or T_left_eye_left_rectified; ignores other poses.
  void take(const TimedPose& pose);
  /// T_frame_camera at a time, or with the nearest known poses. An unknown frame ends the module.
  [[nodiscard]] Eigen::Isometry3d pose_in(std::string_view frame, Time time,
                                          ModuleFrames& frames) const;

 private:
  std::optional<Eigen::Isometry3d> T_head_left_;
  Eigen::Isometry3d T_left_rectified_ = Eigen::Isometry3d::Identity();
};

}  // namespace hc::vision
