// SPDX-License-Identifier: Apache-2.0
#include <room/figure.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <room/body_mesh.h>
#include <room/face_paint.h>
#include <room/face_shape.h>
#include <room/hand_model.h>
#include <room/paint.h>

namespace hc::room {

namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kAnkle = 0.08;    // above the floor [m]
constexpr double kStride = 1.3;    // two steps [m]
constexpr float kCoarse = 0.014F;  // corners of hands that show nothing; most hands do [m]
constexpr double kCloth = 200;     // brightness of its image, of 255

double hip_height(const Look& look) {
  return 0.53 * look.tall;
}

double half_leg(const Look& look) {
  return (hip_height(look) - kAnkle) / 2;
}

Vector3f factor(const Vector3d& rgb) {
  return (rgb / kCloth).cast<float>();
}

graphics::Mesh make_trunk(const Look& look, const Vector3d& skin) {
  const double top = look.tall - 0.165, hips = hip_height(look) - 0.06;
  const double high = top - hips, w = look.wide;
  const Section shirt[] = {{top, -0.015, 0.05, 0.055},
                           {top - 0.015, -0.015, 0.065, 0.085},
                           {top - 0.035, -0.02, 0.08, 0.14 * w},
                           {top - 0.065, -0.02, 0.095, 0.185 * w},
                           {top - 0.1, -0.02, 0.105, 0.19 * w},
                           {top - 0.18, -0.015, 0.115, 0.175 * w},
                           {top - 0.45 * high, -0.01, 0.115, 0.16 * w},
                           {top - 0.7 * high, -0.01, 0.105, 0.15 * w},
                           {hips + 0.1, -0.015, 0.115, 0.165 * w},
                           {hips + 0.02, -0.015, 0.115, 0.17 * w}};
  const Section hip[] = {{hips + 0.05, -0.015, 0.11, 0.165 * w},
                         {hips, -0.015, 0.115, 0.17 * w},
                         {hips - 0.06, -0.015, 0.1, 0.16 * w},
                         {hips - 0.09, -0.015, 0, 0}};
  const Section neck[] = {{look.tall - 0.03, -0.005, 0.045, 0.045},
                          {look.tall - 0.1, 0, 0.052, 0.054},
                          {look.tall - 0.16, -0.005, 0.055, 0.06},
                          {look.tall - 0.22, -0.01, 0.055, 0.08}};
  graphics::Mesh mesh = make_skin(shirt, factor(look.clothes));
  mesh.append(make_skin(hip, factor(look.trousers)));
  mesh.append(make_skin(neck, factor(skin)));
  return mesh;
}

/// The pose of a limb from a point to another.
Isometry3d between(const Vector3d& from, const Vector3d& to) {
  return Translation3d(from) *
         Isometry3d(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), to - from));
}

/// The pose of a limb that bends only forward and back: its x stays forward, and z goes from a
/// point to the one below.
Isometry3d hanging(const Vector3d& from, const Vector3d& to) {
  Eigen::Matrix3d axes;
  axes.col(2) = (to - from).normalized();
  axes.col(1) = -Vector3d::UnitY();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return Translation3d(from) * Isometry3d(axes);
}

}  // namespace

Leg leg_of(const Person& person, int side) {
  const Look& look = look_of(person.number);
  const double swing = 0.42 * std::min(1.0, person.speed / 0.8);
  const double phase =
      2 * std::numbers::pi * person.way / kStride + (side == kLeft ? 0 : std::numbers::pi);
  const double thigh = swing * std::sin(phase);
  const double shin = thigh - 1.1 * swing * std::max(0.0, std::cos(phase)) - 0.1 * swing;
  const double half = half_leg(look);
  Leg leg;
  leg.hip = {-0.015, side_sign(side) * 0.085, hip_height(look)};
  leg.knee = leg.hip + half * Vector3d(std::sin(thigh), 0, -std::cos(thigh));
  leg.ankle = leg.knee + half * Vector3d(std::sin(shin), 0, -std::cos(shin));
  return leg;
}

Figure::Figure(graphics::Renderer& renderer, int person) {
  const Look& look = look_of(person);
  const auto tone = skin_of(look);
  const Vector3d skin(tone[0], tone[1], tone[2]);
  const auto cloth =
      paint_grains(128, 128, cv::Scalar::all(kCloth), 24, static_cast<std::uint64_t>(person) + 40);
  auto add = [&](const graphics::Mesh& mesh) { return renderer.add(mesh, cloth); };
  head_ = renderer.add(make_head(look), paint_head(look));
  trunk_ = add(make_trunk(look, skin));
  upper_arm_ = add(make_limb(kUpperArm, 0.058, 0.044, factor(look.clothes)));
  forearm_ = add(make_limb(kForearm, 0.041, 0.029, factor(skin)));
  thigh_ = add(make_limb(half_leg(look), 0.085, 0.058, factor(look.trousers)));
  auto shin = make_limb(half_leg(look), 0.058, 0.042, factor(look.trousers));
  auto foot = graphics::make_box({0.25F, 0.09F, 0.08F});
  for (auto& vertex : foot.vertices) {
    vertex.position += Eigen::Vector3f(0.06F, 0, -0.04F);
    // A limb has its end upwards.
    vertex.position = {vertex.position.x(), -vertex.position.y(),
                       static_cast<float>(half_leg(look)) - vertex.position.z()};
    vertex.normal = {vertex.normal.x(), -vertex.normal.y(), -vertex.normal.z()};
    vertex.colour.setConstant(0.25F);
  }
  shin.append(foot);
  shin_ = add(shin);
  const auto palm = paint_grains(64, 64, tone, 10, static_cast<std::uint64_t>(person) + 50);
  for (const int side : {kLeft, kRight})
    for (int sign = 0; sign < kSigns; ++sign) {
      const bool is_relaxed = static_cast<Sign>(sign) == Sign::Relaxed;
      const auto& mesh = hand_mesh(side, static_cast<Sign>(sign));
      hands_[static_cast<std::size_t>(side)][static_cast<std::size_t>(sign)] =
          renderer.add(is_relaxed ? graphics::make_coarse(mesh, kCoarse) : mesh, palm);
    }
}

void Figure::add_to(std::vector<graphics::Item>& items, const Person& person) const {
  const Look& look = look_of(person.number);
  const Isometry3d& body = person.T_world_body;
  auto add = [&](graphics::SurfaceId surface, const Isometry3d& pose) {
    items.push_back({surface, pose.cast<float>()});
  };
  add(head_, person.T_world_face);
  add(trunk_, body);
  for (const int side : {kLeft, kRight}) {
    const Hand& hand = person.hands[static_cast<std::size_t>(side)];
    const Vector3d top = body * shoulder(look, side), end = hand.T_world_wrist.translation();
    const Vector3d bend = elbow(top, end, side_sign(side) * body.linear().col(1));
    add(upper_arm_, between(top, bend));
    add(forearm_, between(bend, end));
    add(hands_[static_cast<std::size_t>(side)][static_cast<std::size_t>(hand.sign)],
        hand.T_world_wrist);
    const Leg leg = leg_of(person, side);
    add(thigh_, body * between(leg.hip, leg.knee));
    add(shin_, body * hanging(leg.knee, leg.ankle));
  }
}

}  // namespace hc::room
