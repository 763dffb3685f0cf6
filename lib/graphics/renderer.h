// SPDX-License-Identifier: Apache-2.0
#pragma once
// Renders textured, lit surfaces for a camera, with the depth of each pixel. No messages. For the
// thread that made the renderer.

#include <cstddef>
#include <memory>
#include <span>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <graphics/camera.h>
#include <graphics/mesh.h>
#include <hc/base/result.h>

namespace hc::graphics {

/// A surface of a renderer.
using SurfaceId = std::size_t;

/// A surface at a pose.
struct Item {
  SurfaceId surface = 0;
  Eigen::Isometry3f T_world_object = Eigen::Isometry3f::Identity();
  float scale = 1;  ///< relative to its mesh [1]
};

/// A light source.
struct Light {
  Eigen::Vector3f to_light = Eigen::Vector3f(-0.4F, 0.3F, 0.85F).normalized();  ///< world
  float ambient = 0.55F;  ///< brightness of surfaces facing away [1]
  float diffuse = 0.45F;  ///< additional for surfaces facing the light [1]
  float exposure = 1.0F;  ///< factor of all colours [1]
};

/// Draws with OpenGL 3.3 into memory; needs no window.
class Renderer {
 public:
  /// Errors: Unsupported (no surfaceless EGL, no OpenGL 3.3, or a shader error).
  static Result<std::unique_ptr<Renderer>> make();
  ~Renderer();

  /// Adds a surface.
  ///
  /// @param texture  (H, W, 3) u8, red, green, blue; row 0 at texture coordinate y = 0. One pixel
  ///     is a plain colour.
  SurfaceId add(const Mesh& mesh, const cv::Mat& texture);
  /// Replaces the texture of a surface.
  void set_texture(SurfaceId surface, const cv::Mat& texture);
  /// Removes a surface; a later one may get its number.
  void remove(SurfaceId surface);

  /// @param T_world_camera  optical frame.
  /// @param[out] rgb  (H, W, 3) u8, red, green, blue; allocated if it has another shape.
  /// @param[out] depth  (H, W) f32, z in the camera's frame [m], 0 for background; may be null.
  /// Errors: Unsupported (the image is too large for OpenGL).
  /// Cost: some 10 ms for 800 × 600 without a GPU; 2 ms more with depth.
  Status draw(std::span<const Item> items, const PinholeCamera& camera,
              const Eigen::Isometry3d& T_world_camera, const Light& light, cv::Mat& rgb,
              cv::Mat* depth = nullptr);

  /// Draws only a part of the image.
  ///
  /// @param part  of the image [px].
  /// @param[out] rgba  (H, W, 4) u8 of the part; the last is 255, or 0 for background.
  /// @param[out] depth  (H, W) f32 of the part, as above.
  /// Errors: as above.
  Status draw_part(std::span<const Item> items, const PinholeCamera& camera, const cv::Rect& part,
                   const Eigen::Isometry3d& T_world_camera, const Light& light, cv::Mat& rgba,
                   cv::Mat& depth);

 private:
  struct State;
  Status render(std::span<const Item> items, const PinholeCamera& camera,
                const Eigen::Isometry3d& T_world_camera, const Light& light);
  void read_depth(const PinholeCamera& camera, cv::Mat& depth);
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace hc::graphics
