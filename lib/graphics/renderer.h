// SPDX-License-Identifier: Apache-2.0
#pragma once
// Draws textured, lit surfaces as a camera sees them, with the depth of every pixel. No messages.
// All of it on the thread that has made it.

#include <cstddef>
#include <memory>
#include <span>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <graphics/camera.h>
#include <graphics/mesh.h>
#include <hc/base/result.h>

namespace hc::graphics {

/// A surface that a renderer holds.
using SurfaceId = std::size_t;

/// A surface at a place.
struct Item {
  SurfaceId surface = 0;
  Eigen::Isometry3f T_world_object = Eigen::Isometry3f::Identity();
  float scale = 1;  ///< its size, by that of its mesh [1]
};

/// Where light comes from, and how much.
struct Light {
  Eigen::Vector3f to_light = Eigen::Vector3f(-0.4F, 0.3F, 0.85F).normalized();  ///< world
  float ambient = 0.55F;  ///< of what is turned away from it [1]
  float diffuse = 0.45F;  ///< more of what is turned to it [1]
  float exposure = 1.0F;  ///< what all colours are multiplied by [1]
};

/// Draws with OpenGL 3.3 into memory; needs no window.
class Renderer {
 public:
  /// Errors: Unsupported (no EGL without a surface, or no OpenGL 3.3, with what EGL says; what its
  /// compiler says).
  static Result<std::unique_ptr<Renderer>> make();
  ~Renderer();

  /// Takes a surface in.
  ///
  /// @param texture  (H, W, 3) u8, red, green, blue; row 0 at texture coordinate y = 0. One pixel
  ///     is a plain colour.
  SurfaceId add(const Mesh& mesh, const cv::Mat& texture);
  /// Puts another image on a surface.
  void set_texture(SurfaceId surface, const cv::Mat& texture);

  /// Draws.
  ///
  /// @param T_world_camera  optical frame.
  /// @param[out] rgb  (H, W, 3) u8, red, green, blue; of that shape already, or made.
  /// @param[out] depth  (H, W) f32, z in the camera's frame [m], 0 where nothing is; null:
  /// unwanted. Errors: Unsupported (an image that is larger than OpenGL can draw). Cost: on a
  /// processor alone some 10 ms for 800 × 600; 2 ms more with the depth.
  Status draw(std::span<const Item> items, const PinholeCamera& camera,
              const Eigen::Isometry3d& T_world_camera, const Light& light, cv::Mat& rgb,
              cv::Mat* depth = nullptr);

  /// The same of a part of the image alone, without what is around it.
  ///
  /// @param part  of the image [px].
  /// @param[out] rgba  (H, W, 4) u8 of the part; the last is 255, or 0 where nothing is.
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
