// SPDX-License-Identifier: Apache-2.0
#pragma once
// Draws things into a camera's image as if they were there: what is before them hides them.
// No messages. All of it on the thread that has made the renderer.

#include <array>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <graphics/model.h>
#include <graphics/renderer.h>

namespace hc::graphics {

/// A thing at a place.
struct Body {
  std::vector<SurfaceId> surfaces;
  Eigen::AlignedBox3d bounds;  ///< of all its corners, in its own frame, before it is scaled [m]
  double scale = 1;            ///< of its size [1]
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();

  /// Makes its longest side so long [m].
  void set_size(double size);
  [[nodiscard]] std::vector<Item> items() const;
  /// The corners of its bounds, in the world [m].
  [[nodiscard]] std::array<Eigen::Vector3d, 8> corners() const;
};

/// Has a renderer hold a model.
Body make_body(Renderer& renderer, const std::vector<Part>& parts);

/// The part of an image in which a body is seen; empty where it is not.
cv::Rect part_of(const Body& body, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera);

class Overlay {
 public:
  /// Gives the nearness of the scene in a part of the image: see occlusion.h.
  using Nearness = std::function<void(const cv::Rect& part, cv::Mat& nearness)>;
  struct View {
    PinholeCamera camera;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    Light light = {};
    double scale = 0;   ///< focal length · baseline: from depth to nearness [px · m]
    Nearness nearness;  ///< of the scene; empty: nothing hides a body
  };

  /// @param renderer  outlives it.
  explicit Overlay(Renderer& renderer) : renderer_(renderer) {}

  /// Draws bodies into an image. A body is hidden where the scene is nearer by more than kMargin;
  /// where that begins and ends is looked for in the image's colours, too, as depth is coarse at
  /// edges.
  ///
  /// @param[in,out] image  (H, W, 3) u8, red, green, blue.
  /// @param[in,out] mask  (H, W) u8: what was drawn is written into it, up to 255 where a pixel
  ///     shows a body alone. Null: unwanted.
  /// Errors: as Renderer::draw().
  /// Cost: what takes part is the bodies' rectangle; doc/augment.md has figures. All cores.
  Status draw(std::span<const Body> bodies, const View& view, cv::Mat& image,
              cv::Mat* mask = nullptr);

  static constexpr float kMargin = 0.25F;  ///< by which what is drawn may be behind the scene [px]
  static constexpr float kSoft = 0.5F;     ///< over which it vanishes then [px]

 private:
  Status draw_part(const std::vector<Item>& items, const View& view, const cv::Rect& part,
                   cv::Mat& image, cv::Mat* mask);

  Renderer& renderer_;
  std::vector<std::uint8_t> rgba_;
  std::vector<float> depth_;
  cv::Mat nearness_, seen_, opacity_;
};

}  // namespace hc::graphics
