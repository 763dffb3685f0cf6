// SPDX-License-Identifier: Apache-2.0
#include <graphics/model.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hc/compress/compress.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::graphics {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostVertices = 10'000'000;

// assimp reads more formats, but some readers trust a file's counts and run for hours.
constexpr std::array<std::string_view, 4> kFormats = {".obj", ".stl", ".gltf", ".glb"};

/// The ending of a file's name, in small letters.
std::string ending_of(const fs::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// A linear part of a colour as it is in images (sRGB, IEC 61966-2-1). Both 0 … 1.
float srgb(float linear) {
  const float value = std::clamp(linear, 0.0F, 1.0F);
  return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F;
}

Eigen::Vector3f colour_of(float r, float g, float b, bool is_linear) {
  return is_linear ? Eigen::Vector3f(srgb(r), srgb(g), srgb(b)) : Eigen::Vector3f(r, g, b);
}

/// Replaces normals that are zero or not numbers, as some programs write them, by those of the
/// triangles around.
void mend_normals(Mesh& mesh) {
  const auto is_normal = [](const Eigen::Vector3f& n) { return n.allFinite() && !n.isZero(0); };
  std::vector<Eigen::Vector3f> sums(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t corner) {
      return mesh.vertices[mesh.indices[i + corner]].position;
    };
    const Eigen::Vector3f normal = (at(1) - at(0)).cross(at(2) - at(0));  // longer if it is larger
    for (std::size_t corner = 0; corner < 3; ++corner) sums[mesh.indices[i + corner]] += normal;
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (!is_normal(mesh.vertices[i].normal) && is_normal(sums[i]))
      mesh.vertices[i].normal = sums[i].stableNormalized();
}

/// @param is_linear  its colours are linear, as those of glTF.
Mesh mesh_of(const aiMesh& from, bool is_linear) {
  Mesh mesh;
  mesh.vertices.reserve(from.mNumVertices);
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const auto &p = from.mVertices[i], &n = from.mNormals[i];
    Vertex vertex{{p.x, p.y, p.z}, {n.x, n.y, n.z}};
    if (from.HasTextureCoords(0))
      vertex.texture = {from.mTextureCoords[0][i].x, from.mTextureCoords[0][i].y};
    if (from.HasVertexColors(0)) {
      const auto& c = from.mColors[0][i];
      vertex.colour = colour_of(c.r, c.g, c.b, is_linear);
    }
    mesh.vertices.push_back(vertex);
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices == 3)
      mesh.indices.insert(mesh.indices.end(), face.mIndices, face.mIndices + 3);
  }
  mend_normals(mesh);
  return mesh;
}

/// The file that a model names: on Windows with backslashes, in glTF as a part of a URI.
///
/// @param path  the name behind the model's folder, which is taken as it is.
std::string file_named(const std::string& path, const std::string& folder) {
  std::error_code none;
  if (fs::exists(path, none)) return path;
  const auto kept = path.starts_with(folder) ? folder.size() : 0;
  std::string name = path.substr(kept);
  std::ranges::replace(name, '\\', '/');
  std::string plain;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool is_escape = name[i] == '%' && i + 2 < name.size() &&
                           std::isxdigit(static_cast<unsigned char>(name[i + 1])) != 0 &&
                           std::isxdigit(static_cast<unsigned char>(name[i + 2])) != 0;
    plain += is_escape ? static_cast<char>(std::stoi(name.substr(i + 1, 2), nullptr, 16)) : name[i];
    if (is_escape) i += 2;
  }
  plain.insert(0, folder, 0, kept);
  return fs::exists(plain, none) ? plain : path.substr(0, kept) + name;
}

/// The files of a model, such as the buffers of glTF.
class Files : public Assimp::DefaultIOSystem {
 public:
  explicit Files(std::string folder) : folder_(std::move(folder)) {}

  bool Exists(const char* name) const override {
    return DefaultIOSystem::Exists(file_named(name, folder_).c_str());
  }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return DefaultIOSystem::Open(file_named(name, folder_).c_str(), mode);
  }

 private:
  std::string folder_;
};

/// The file of a texture, embedded or in the model's folder; empty if there is none.
std::vector<std::uint8_t> texture_file(const aiScene& scene, const char* name,
                                       const fs::path& folder) {
  const aiTexture* inside = scene.GetEmbeddedTexture(name);
  if (inside == nullptr) {
    const auto path = file_named(folder / name, folder);
    std::error_code none;
    if (!fs::is_regular_file(path, none)) return {};
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator(file), {}};
  }
  const bool is_packed = inside->mHeight == 0;  // PNG or JPEG; these model formats have no others
  if (!is_packed) return {};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(inside->pcData);
  return {bytes, bytes + inside->mWidth};
}

/// A texture of a model. Errors: Malformed (not an image, or a damaged one).
Result<cv::Mat> read_texture(const aiScene& scene, const char* name, const fs::path& folder) {
  const auto file = texture_file(scene, name, folder);
  constexpr std::array<std::uint8_t, 2> kJpeg{0xff, 0xd8};
  auto refuse = [&](const std::string& why) {
    return Error{Code::Malformed, (folder / name).string() + ": " + why};
  };
  if (file.size() > 2 && std::equal(kJpeg.begin(), kJpeg.end(), file.begin()))
    if (const auto whole = check_jpeg(std::as_bytes(std::span(file))); !whole)
      return refuse(whole.error().detail);
  cv::Mat image = file.empty() ? cv::Mat() : cv::imdecode(file, cv::IMREAD_COLOR);
  if (image.empty()) return refuse("not an image");
  return image;
}

/// @param is_linear  plain colours are linear, as those of glTF.
Result<cv::Mat> texture_of(const aiScene& scene, const aiMesh& mesh, const fs::path& folder,
                           bool is_linear) {
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  aiString name;
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) == AI_SUCCESS) {
    cv::Mat image = HC_TRY(read_texture(scene, name.C_Str(), folder));
    cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
    return image;
  }
  // The grey of a material that the file does not have would darken the colours of vertices.
  const bool has_default = material.GetName() == aiString(AI_DEFAULT_MATERIAL_NAME);
  if (has_default && mesh.HasVertexColors(0)) return cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(255));
  aiColor3D colour(0.8F, 0.8F, 0.8F);
  const bool is_given = material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS;
  const Eigen::Vector3f rgb = 255 * colour_of(colour.r, colour.g, colour.b, is_given && is_linear);
  return cv::Mat(1, 1, CV_8UC3, cv::Scalar(rgb[0], rgb[1], rgb[2]));
}

}  // namespace

Result<std::vector<Part>> read_model(const std::string& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return Error{Code::NotFound, path + ": no such file"};
  const std::string ending = ending_of(path);
  if (std::ranges::find(kFormats, ending) == kFormats.end())
    return Error{Code::Unsupported, path + ": not a model (.obj, .stl, .gltf or .glb)"};
  const bool is_gltf = ending == ".gltf" || ending == ".glb";
  // Many programs write zeros for the normals of an .stl.
  const unsigned normals = ending == ".stl" ? aiProcess_ForceGenNormals | aiProcess_GenNormals
                                            : unsigned{aiProcess_GenSmoothNormals};
  Assimp::Importer importer;
  importer.SetIOHandler(new Files(fs::path(path).parent_path()));  // which it deletes
  const aiScene* scene = importer.ReadFile(
      path, normals | aiProcess_Triangulate | aiProcess_PreTransformVertices |
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
    auto texture = HC_TRY(texture_of(*scene, mesh, fs::path(path).parent_path(), is_gltf));
    parts.push_back({mesh_of(mesh, is_gltf), texture});
  }
  if (parts.empty()) return Error{Code::Malformed, path + ": has no triangle"};
  return parts;
}

}  // namespace hc::graphics
