// SPDX-License-Identifier: Apache-2.0
#pragma once
// Models from files. No messages.

#include <string>
#include <vector>

#include <graphics/mesh.h>
#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::graphics {

/// A surface of a model and its texture.
struct Part {
  Mesh mesh;
  cv::Mat texture;  ///< (H, W, 3) u8, red, green, blue; one pixel is a plain colour
};

/// Reads a model: Wavefront .obj, .stl, .gltf or .glb. Lengths are in metres; axes are unchanged;
/// textures are embedded or in the same folder; vertices may have colours. The sides of an .stl are
/// flat, whatever its normals; in the others, missing normals are computed.
///
/// Errors: NotFound (no such file); Unsupported (another format); Malformed (from assimp; invalid
/// texture; no triangle; more than 10 million vertices).
Result<std::vector<Part>> read_model(const std::string& path);

}  // namespace hc::graphics
