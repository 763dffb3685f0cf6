// SPDX-License-Identifier: Apache-2.0
#pragma once
// Draws bodies into a camera's image, with occlusion by the scene. No messages. For the thread that
// made the renderer.

#include <array>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <graphics/model.h>
#include <graphics/renderer.h>

namespace hc::graphics {

/// A body at a pose.
struct Body {
  std::vector<SurfaceId> surfaces;
  Eigen::AlignedBox3d bounds;  ///< in its frame, before scaling [m]
  double scale = 1;            ///< of its size [1]
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();

  /// Sets the length of its longest side [m].
  void set_size(double size);
  [[nodiscard]] std::vector<Item> items() const;
  /// The corners of its bounds, in the world [m].
  [[nodiscard]] std::array<Eigen::Vector3d, 8> corners() const;
};

/// Loads a model into a renderer.
Body make_body(Renderer& renderer, const std::vector<Part>& parts);

/// The part of an image that a body covers; empty if outside.
cv::Rect part_of(const Body& body, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera);

class Overlay {
 public:
  /// Computes the nearness of the scene in a part of the image: see occlusion.h.
  using Nearness = std::function<void(const cv::Rect& part, cv::Mat& nearness)>;
  struct View {
    PinholeCamera camera;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    Light light = {};
    double scale = 0;   ///< focal length · baseline: from depth to nearness [px · m]
    Nearness nearness;  ///< of the scene; empty: nothing hides a body
  };

  /// @param renderer  must outlive the overlay.
  explicit Overlay(Renderer& renderer) : renderer_(renderer) {}

  /// Draws bodies into an image. The scene hides a body if it is nearer by more than kMargin. Since
  /// depth is coarse at edges, their position is refined with the image's colours.
  ///
  /// @param[in,out] image  (H, W, 3) u8, red, green, blue.
  /// @param[in,out] mask  (H, W) u8: opacity of the bodies is written into it, up to 255. May be
  ///     null.
  /// Errors: as Renderer::draw().
  /// Cost: proportional to the bodies' rectangles; doc/augment.md has figures. All cores.
  Status draw(std::span<const Body> bodies, const View& view, cv::Mat& image,
              cv::Mat* mask = nullptr);

  static constexpr float kMargin = 0.25F;  ///< by which a body may be behind the scene [px]
  static constexpr float kSoft = 0.5F;     ///< over which it then fades out [px]

 private:
  Status draw_part(const std::vector<Item>& items, const View& view, const cv::Rect& part,
                   cv::Mat& image, cv::Mat* mask);

  Renderer& renderer_;
  std::vector<std::uint8_t> rgba_;
  std::vector<float> depth_;
  cv::Mat nearness_, seen_, opacity_;
};

}  // namespace hc::graphics
