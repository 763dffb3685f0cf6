// SPDX-License-Identifier: Apache-2.0
#include <graphics/model.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <string_view>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::graphics {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostVertices = 10'000'000;

// assimp reads more formats, but some readers trust a file's counts and run for hours.
constexpr std::array<std::string_view, 4> kFormats = {".obj", ".stl", ".gltf", ".glb"};

Mesh mesh_of(const aiMesh& from) {
  Mesh mesh;
  mesh.vertices.reserve(from.mNumVertices);
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const auto &p = from.mVertices[i], &n = from.mNormals[i];
    Vertex vertex{{p.x, p.y, p.z}, {n.x, n.y, n.z}, {0, 0}};
    if (from.HasTextureCoords(0))
      vertex.texture = {from.mTextureCoords[0][i].x, from.mTextureCoords[0][i].y};
    mesh.vertices.push_back(vertex);
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices == 3)
      mesh.indices.insert(mesh.indices.end(), face.mIndices, face.mIndices + 3);
  }
  return mesh;
}

/// A texture of a model, embedded or in the model's folder; empty if it cannot be read.
cv::Mat read_texture(const aiScene& scene, const char* name, const fs::path& folder) {
  const aiTexture* inside = scene.GetEmbeddedTexture(name);
  if (inside == nullptr) return cv::imread((folder / name).string(), cv::IMREAD_COLOR);
  const bool is_packed = inside->mHeight == 0;  // PNG or JPEG; these model formats have no others
  if (!is_packed || inside->mWidth == 0) return {};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(inside->pcData);
  return cv::imdecode(std::vector<std::uint8_t>(bytes, bytes + inside->mWidth), cv::IMREAD_COLOR);
}

Result<cv::Mat> texture_of(const aiScene& scene, const aiMaterial& material,
                           const fs::path& folder) {
  aiString name;
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) == AI_SUCCESS) {
    cv::Mat image = read_texture(scene, name.C_Str(), folder);
    if (image.empty())
      return Error{Code::Malformed, (folder / name.C_Str()).string() + ": not an image"};
    cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
    return image;
  }
  aiColor3D colour(0.8F, 0.8F, 0.8F);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  return cv::Mat(1, 1, CV_8UC3, cv::Scalar(255 * colour.r, 255 * colour.g, 255 * colour.b));
}

}  // namespace

Result<std::vector<Part>> read_model(const std::string& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return Error{Code::NotFound, path + ": no such file"};
  if (std::find(kFormats.begin(), kFormats.end(), fs::path(path).extension()) == kFormats.end())
    return Error{Code::Unsupported, path + ": not a model (.obj, .stl, .gltf or .glb)"};
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(
      path, aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_PreTransformVertices |
                aiProcess_JoinIdenticalVertices | aiProcess_SortByPType | aiProcess_FlipUVs);
  if (scene == nullptr) return Error{Code::Malformed, path + ": " + importer.GetErrorString()};
  std::vector<Part> parts;
  std::size_t vertices = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& mesh = *scene->mMeshes[i];
    if ((mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0 || !mesh.HasNormals()) continue;
    vertices += mesh.mNumVertices;
    if (vertices > kMostVertices)
      return Error{Code::Malformed, path + ": has more than 10 million corners"};
    auto texture = HC_TRY(
        texture_of(*scene, *scene->mMaterials[mesh.mMaterialIndex], fs::path(path).parent_path()));
    parts.push_back({mesh_of(mesh), texture});
  }
  if (parts.empty()) return Error{Code::Malformed, path + ": has no triangle"};
  return parts;
}

}  // namespace hc::graphics
