// SPDX-License-Identifier: Apache-2.0
#pragma once
// The objects, where they are in the world, and how the two eyes see them. Knows no ports.

#include <map>
#include <memory>
#include <vector>

#include <frames/module_frames.h>
#include <frames/rigid.h>
#include <graphics/overlay.h>

#include "objects.h"
#include "pair.h"

/// Markers' poses in the world, made smooth: a marker's is known until another is seen, since what
/// it is fixed to does not go away when it is hidden.
class Markers {
 public:
  /// @param number  of the marker's frame. @param time  [ns]
  /// @param smoothing  time constant [s].
  void see(int number, std::int64_t time, const Eigen::Isometry3d& T_world_marker,
           double smoothing);
  /// Its pose; null where it has not been seen.
  [[nodiscard]] const Eigen::Isometry3d* find(int number) const;

 private:
  struct Seen {
    std::int64_t time = 0;
    Eigen::Isometry3d pose;
  };
  std::map<int, Seen> seen_;
};

/// What is drawn: holds OpenGL, so for one thread.
class Scene {
 public:
  /// Errors: as hc::graphics::Renderer::make(), read_objects(), load().
  static hc::Result<std::unique_ptr<Scene>> make(const std::string& objects);

  /// Puts all objects to their places at a time; those at markers that have not been seen are left
  /// out. A name that no frame has ends the module.
  void place(hc::ModuleFrames& frames, const Markers& markers, std::int64_t time);
  [[nodiscard]] const std::vector<hc::graphics::Body>& bodies() const { return placed_; }
  /// Whether an eye sees any of them.
  [[nodiscard]] bool is_seen(const Sight& sight) const;

  /// The corners of the boxes around them, 8 an object: x, y in the left and x, y in the right
  /// image [px]; NaN where they are not before the eye.
  [[nodiscard]] std::vector<double> corners(const Sight& sight) const;

  /// Draws what an eye sees of them. @param depth  (H, W) f32 of the left image [m], 0 unknown.
  /// Errors: as hc::graphics::Overlay::draw().
  hc::Status draw(const Sight& sight, std::size_t eye, const cv::Mat& depth, cv::Mat& image,
                  cv::Mat* mask);

 private:
  explicit Scene(std::unique_ptr<hc::graphics::Renderer> renderer)
      : renderer_(std::move(renderer)), overlay_(*renderer_) {}

  std::unique_ptr<hc::graphics::Renderer> renderer_;
  hc::graphics::Overlay overlay_;
  std::vector<Object> objects_;
  std::vector<hc::graphics::Body> bodies_, placed_;  // of all objects; of those with a known place
};
