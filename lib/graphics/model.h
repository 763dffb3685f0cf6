// SPDX-License-Identifier: Apache-2.0
#pragma once
// Models from files. No messages.

#include <string>
#include <vector>

#include <graphics/mesh.h>
#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::graphics {

/// A surface of a model, and what is painted on it.
struct Part {
  Mesh mesh;
  cv::Mat texture;  ///< (H, W, 3) u8, red, green, blue; one pixel is a plain colour
};

/// Reads a model: Wavefront .obj, .stl, .gltf or .glb. Its lengths are taken as metres, its axes as
/// they are; textures lie in it or beside it. Normals are made where it has none.
///
/// Errors: NotFound (no such file); Unsupported (another format); Malformed (what assimp says; a
/// texture that is no image; no triangle; more than 10 million corners).
Result<std::vector<Part>> read_model(const std::string& path);

}  // namespace hc::graphics
