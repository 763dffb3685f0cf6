// SPDX-License-Identifier: Apache-2.0
#include <room/hand_model.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <graphics/skin.h>
#include <hc/base/check.h>
#include <room/assets.h>

namespace hc::room {

namespace {

using Eigen::AngleAxisf;
using Eigen::Isometry3f;
using Eigen::Vector3f;

constexpr int kFingers = 5;
constexpr float kDegree = std::numbers::pi_v<float> / 180;

/// How a finger is bent at its joints, towards the palm, and spread to the thumb's side [degree].
struct Bend {
  float root = 0, middle = 0, end = 0, spread = 0;
};

/// How the thumb is bent at its joints; its root also turns across the palm, and about itself
/// [degree].
struct ThumbBend {
  float root = 0, middle = 0, end = 0, across = 0, roll = 0;
};

struct Posture {
  ThumbBend thumb;
  std::array<Bend, 4> fingers;  // from the index finger
};

Posture posture_of(Sign sign) {
  constexpr Bend kBent{80, 100, 60, 0};
  constexpr ThumbBend kFolded{30, 35, 45, 30, 20};
  switch (sign) {
    case Sign::Relaxed:
      return {{5, 10, 15, 5, 0}, {{{15, 20, 12}, {20, 24, 14}, {24, 26, 16}, {26, 28, 16}}}};
    case Sign::Open:
      return {{-5, 0, 0, -12, 0}, {{{0, 0, 0, 6}, {0, 0, 0, 1}, {0, 0, 0, -4}, {0, 0, 0, -10}}}};
    case Sign::Point:
      return {kFolded, {{{0, 0, 0, 0}, kBent, kBent, kBent}}};
    case Sign::Fist:
      return {kFolded, {{kBent, kBent, kBent, kBent}}};
    case Sign::Thumb:
      return {{-15, -5, -5, -25, 0}, {{kBent, kBent, kBent, kBent}}};
    case Sign::Victory:
      return {kFolded, {{{0, 0, 0, 12}, {0, 0, 0, -8}, kBent, kBent}}};
  }
  return {};
}

/// The joints of a finger in the model, from the metacarpal to the tip.
std::vector<std::string> names_of(int finger) {
  if (finger == 0)
    return {"thumb-metacarpal", "thumb-phalanx-proximal", "thumb-phalanx-distal", "thumb-tip"};
  static const std::array<std::string, kFingers> kNames = {"", "index", "middle", "ring", "pinky"};
  const std::string name = kNames[static_cast<std::size_t>(finger)] + "-finger-";
  return {name + "metacarpal", name + "phalanx-proximal", name + "phalanx-intermediate",
          name + "phalanx-distal", name + "tip"};
}

class Rig {
 public:
  explicit Rig(int side) : side_(side) {
    auto skin = graphics::read_skin(side == kLeft ? left_hand_model() : right_hand_model());
    HC_CHECK(skin.has_value());
    skin_ = *std::move(skin);
    const Isometry3f T_wrist_mesh = skin_.bones[index("wrist")].T_mesh_bone.inverse();
    for (auto& vertex : skin_.mesh.vertices) {
      vertex.position = T_wrist_mesh * vertex.position;
      vertex.normal = T_wrist_mesh.linear() * vertex.normal;
    }
    for (auto& bone : skin_.bones) bone.T_mesh_bone = T_wrist_mesh * bone.T_mesh_bone;
  }

  /// The poses of all bones.
  [[nodiscard]] std::vector<Isometry3f> poses(Sign sign) const {
    const Posture posture = posture_of(sign);
    std::vector<Isometry3f> poses;
    for (const auto& bone : skin_.bones) poses.push_back(bone.T_mesh_bone);
    for (int finger = 0; finger < kFingers; ++finger) {
      const auto turns = finger == 0
                             ? turns_of(posture.thumb)
                             : turns_of(posture.fingers[static_cast<std::size_t>(finger - 1)]);
      const auto names = names_of(finger);
      Isometry3f move = Isometry3f::Identity();  // of all that follows, in the wrist's frame
      for (std::size_t i = 0; i < names.size(); ++i) {
        const std::size_t bone = index(names[i]);
        const Isometry3f& rest = skin_.bones[bone].T_mesh_bone;
        move = move * rest * turns[i] * rest.inverse();
        poses[bone] = move * rest;
      }
    }
    return poses;
  }

  [[nodiscard]] std::size_t index(const std::string& name) const {
    const auto found = std::ranges::find(skin_.bones, name, &graphics::Bone::name);
    HC_CHECK(found != skin_.bones.end(), name);
    return static_cast<std::size_t>(found - skin_.bones.begin());
  }
  [[nodiscard]] const graphics::Skin& skin() const { return skin_; }

 private:
  /// Towards the palm, since a joint's fingers are along −z and its back along y.
  static AngleAxisf bent(float angle) { return {-angle * kDegree, Vector3f::UnitX()}; }
  [[nodiscard]] float outwards() const { return side_ == kRight ? 1 : -1; }
  [[nodiscard]] AngleAxisf sideways(float angle) const {
    return {outwards() * angle * kDegree, Vector3f::UnitY()};
  }
  [[nodiscard]] std::vector<Isometry3f> turns_of(const Bend& bend) const {
    return {Isometry3f::Identity(), Isometry3f(sideways(bend.spread) * bent(bend.root)),
            Isometry3f(bent(bend.middle)), Isometry3f(bent(bend.end)), Isometry3f::Identity()};
  }
  [[nodiscard]] std::vector<Isometry3f> turns_of(const ThumbBend& bend) const {
    const AngleAxisf rolled(outwards() * bend.roll * kDegree, Vector3f::UnitZ());
    return {Isometry3f(sideways(-bend.across) * bent(bend.root) * rolled),
            Isometry3f(bent(bend.middle)), Isometry3f(bent(bend.end)), Isometry3f::Identity()};
  }

  int side_;
  graphics::Skin skin_;
};

const Rig& rig_of(int side) {
  static const Rig kLeftRig(kLeft), kRightRig(kRight);
  return side == kLeft ? kLeftRig : kRightRig;
}

}  // namespace

const std::array<Eigen::Vector3d, kHandJoints>& hand_joints(int side, Sign sign) {
  static std::map<std::pair<int, Sign>, std::array<Eigen::Vector3d, kHandJoints>> known;
  const auto [made, is_new] = known.try_emplace({side, sign});
  auto& joints = made->second;
  if (!is_new) return joints;
  const Rig& rig = rig_of(side);
  const auto poses = rig.poses(sign);
  std::size_t next = 0;
  auto add = [&](const std::string& name) {
    joints[next++] = poses[rig.index(name)].translation().cast<double>();
  };
  add("wrist");
  for (int finger = 0; finger < kFingers; ++finger) {
    const auto names = names_of(finger);
    for (std::size_t i = names.size() - 4; i < names.size(); ++i) add(names[i]);
  }
  return joints;
}

const graphics::Mesh& hand_mesh(int side, Sign sign) {
  static std::map<std::pair<int, Sign>, graphics::Mesh> known;
  const auto [made, is_new] = known.try_emplace({side, sign});
  if (is_new) made->second = graphics::posed(rig_of(side).skin(), rig_of(side).poses(sign));
  return made->second;
}

}  // namespace hc::room
