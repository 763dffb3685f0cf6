// SPDX-License-Identifier: Apache-2.0
#include <graphics/skin.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>

#include <hc/base/check.h>

namespace hc::graphics {
namespace {

Result<Bone> bone_of(const aiBone& bone) {
  Eigen::Matrix4f T_bone_mesh;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column)
      T_bone_mesh(row, column) = bone.mOffsetMatrix[row][column];
  const Eigen::Matrix3f turn = T_bone_mesh.topLeftCorner<3, 3>();
  if (!(turn * turn.transpose()).isIdentity(0.01F))
    return Error{Code::Malformed, std::string("bone ") + bone.mName.C_Str() + " is stretched"};
  return Bone{bone.mName.C_Str(), Eigen::Isometry3f(T_bone_mesh).inverse()};
}

/// Keeps the largest shares of a vertex.
void add(Hold& hold, std::uint32_t bone, float share) {
  const auto least = std::ranges::min_element(hold.shares) - hold.shares.begin();
  const auto place = static_cast<std::size_t>(least);
  if (share <= hold.shares[place]) return;
  hold.bones[place] = bone;
  hold.shares[place] = share;
}

Result<Skin> skin_of(const aiMesh& from) {
  Skin skin;
  skin.holds.resize(from.mNumVertices);
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const auto &p = from.mVertices[i], &n = from.mNormals[i];
    Vertex vertex{{p.x, p.y, p.z}, {n.x, n.y, n.z}};
    if (from.HasTextureCoords(0))
      vertex.texture = {from.mTextureCoords[0][i].x, from.mTextureCoords[0][i].y};
    skin.mesh.vertices.push_back(vertex);
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices == 3)
      skin.mesh.indices.insert(skin.mesh.indices.end(), face.mIndices, face.mIndices + 3);
  }
  for (unsigned i = 0; i < from.mNumBones; ++i) {
    const aiBone& bone = *from.mBones[i];
    skin.bones.push_back(HC_TRY(bone_of(bone)));
    for (unsigned k = 0; k < bone.mNumWeights; ++k)
      add(skin.holds.at(bone.mWeights[k].mVertexId), i, bone.mWeights[k].mWeight);
  }
  for (auto& hold : skin.holds) {
    float sum = 0;
    for (const float share : hold.shares) sum += share;
    if (sum <= 0) return Error{Code::Malformed, "a corner without a bone"};
    for (float& share : hold.shares) share /= sum;
  }
  return skin;
}

}  // namespace

Result<Skin> read_skin(std::span<const std::byte> glb) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFileFromMemory(glb.data(), glb.size(),
                                  aiProcess_Triangulate | aiProcess_GenSmoothNormals |
                                      aiProcess_JoinIdenticalVertices | aiProcess_FlipUVs,
                                  "glb");
  if (scene == nullptr) return Error{Code::Malformed, importer.GetErrorString()};
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
    if (scene->mMeshes[i]->HasBones() && scene->mMeshes[i]->HasNormals())
      return skin_of(*scene->mMeshes[i]);
  return Error{Code::Malformed, "has no surface with bones"};
}

Mesh posed(const Skin& skin, std::span<const Eigen::Isometry3f> T_mesh_bone) {
  HC_CHECK(T_mesh_bone.size() == skin.bones.size(), T_mesh_bone.size(), skin.bones.size());
  std::vector<Eigen::Isometry3f> moves;
  for (std::size_t i = 0; i < skin.bones.size(); ++i)
    moves.push_back(T_mesh_bone[i] * skin.bones[i].T_mesh_bone.inverse());
  Mesh mesh = skin.mesh;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Hold& hold = skin.holds[i];
    const Vertex& rest = skin.mesh.vertices[i];
    Eigen::Vector3f position = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < hold.bones.size(); ++k) {
      const auto& move = moves[hold.bones[k]];
      position += hold.shares[k] * (move * rest.position);
      normal += hold.shares[k] * (move.linear() * rest.normal);
    }
    mesh.vertices[i].position = position;
    mesh.vertices[i].normal = normal.normalized();
  }
  return mesh;
}

}  // namespace hc::graphics
