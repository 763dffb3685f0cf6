// SPDX-License-Identifier: Apache-2.0
#pragma once
// The objects and people's name tags, their poses in the world, and their rendering for both eyes.
// No ports.

#include <map>
#include <memory>
#include <vector>

#include <frames/module_frames.h>
#include <frames/rigid.h>
#include <graphics/overlay.h>

#include "objects.h"
#include "pair.h"
#include "tags.h"

/// Smoothed poses of markers in the world. A pose is kept while its marker is hidden, since the
/// marked thing is still there.
class Markers {
 public:
  /// @param number  of the marker's frame.
  /// @param smoothing  time constant [s].
  void see(int number, hc::Time time, const Eigen::Isometry3d& T_world_marker, double smoothing);
  /// T_world_marker; null if not yet seen.
  [[nodiscard]] const Eigen::Isometry3d* find(int number) const;

 private:
  struct Seen {
    hc::Time time;
    Eigen::Isometry3d pose;
  };
  std::map<int, Seen> seen_;
};

/// Renders the objects and tags. Owns an OpenGL context: one thread only.
class Scene {
 public:
  /// Errors: as read_objects(), load().
  static hc::Result<std::unique_ptr<Scene>> make(const std::string& objects,
                                                 std::unique_ptr<hc::graphics::Renderer> renderer);

  /// Places all objects for a time, except those at markers not yet seen. An unknown frame
  /// name ends the module.
  void place(hc::ModuleFrames& frames, const Markers& markers, hc::Time time);
  /// Places a tag over each face, for the eyes at a time.
  void tag(const std::vector<NamedFace>& faces, const Sight& sight) { tags_.place(faces, sight); }
  /// The placed objects.
  [[nodiscard]] const std::vector<hc::graphics::Body>& bodies() const { return placed_; }
  /// Whether an eye sees any object or tag.
  [[nodiscard]] bool is_seen(const Sight& sight) const;

  /// Corners of the objects' bounding boxes, 8 an object: x, y in the left and x, y in the right
  /// image [px]; NaN behind the eye.
  [[nodiscard]] std::vector<double> corners(const Sight& sight) const;

  /// Draws the visible parts for an eye. @param depth  (H, W) f32 of the left image [m], 0 unknown.
  /// Errors: as hc::graphics::Overlay::draw().
  hc::Status draw(const Sight& sight, std::size_t eye, const cv::Mat& depth, cv::Mat& image,
                  cv::Mat* mask);

 private:
  explicit Scene(std::unique_ptr<hc::graphics::Renderer> renderer)
      : renderer_(std::move(renderer)), overlay_(*renderer_), tags_(*renderer_) {}

  std::unique_ptr<hc::graphics::Renderer> renderer_;
  hc::graphics::Overlay overlay_;
  Tags tags_;
  std::vector<Object> objects_;
  std::vector<hc::graphics::Body> bodies_, placed_;  // of all objects; of those with a known pose
};
