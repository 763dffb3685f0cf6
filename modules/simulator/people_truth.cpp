// SPDX-License-Identifier: Apache-2.0
#include "people_truth.h"

#include <algorithm>
#include <cmath>

#include <room/face_shape.h>
#include <room/hand_model.h>
#include <room/person_seen.h>

std::array<double, 10> row_of(std::span<const hc::room::Person> people, std::size_t index,
                              const Eigen::Isometry3d& T_world_eye,
                              const hc::graphics::PinholeCamera& camera) {
  const auto& person = people[index];
  const Eigen::Vector3d p = person.T_world_face.translation();
  const Eigen::Vector3d ahead = person.T_world_face.linear().col(0);
  const double speaks = person.speaks ? 1 : 0, yaw = std::atan2(ahead.y(), ahead.x());
  const double number = person.number + 1;
  const Eigen::Isometry3d T_eye_world = T_world_eye.inverse();
  const Eigen::Vector3d p_eye = T_eye_world * p;
  if (p_eye.z() <= camera.near) return {number, p.x(), p.y(), p.z(), yaw, speaks, 0, 0, 0, 0};
  const Eigen::Vector2d pixel = camera.project(p_eye);
  const double width = hc::room::kFaceWidth * hc::room::look_of(person.number).wide;
  auto is_in_view = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = T_eye_world * point;
    return at.z() > camera.near && camera.contains(camera.project(at));
  };
  return {number,
          p.x(),
          p.y(),
          p.z(),
          yaw,
          speaks,
          pixel.x(),
          pixel.y(),
          camera.fx * width / p_eye.z(),
          hc::room::face_seen(people, index, T_world_eye.translation(), is_in_view)};
}

std::array<double, 8> joint_row(const hc::room::Person& person, int side, int joint,
                                const Eigen::Isometry3d& T_world_eye,
                                const hc::graphics::PinholeCamera& camera) {
  const auto& hand = person.hands[static_cast<std::size_t>(side)];
  const Eigen::Vector3d p =
      hand.T_world_wrist * hc::room::hand_joints(side, hand.sign)[static_cast<std::size_t>(joint)];
  const Eigen::Vector3d p_eye = T_world_eye.inverse() * p;
  Eigen::Vector2d pixel(0, 0);
  if (p_eye.z() > camera.near) pixel = camera.project(p_eye);
  return {double(person.number + 1),
          double(side),
          double(joint),
          p.x(),
          p.y(),
          p.z(),
          pixel.x(),
          pixel.y()};
}

PeopleTruth::PeopleTruth(hc::Module& module)
    : people_(module.output(
          "people", hc::table(),
          "truth, a row for each person: between the eyes in the world and in the left image; yaw "
          "of the face in the world; its width in the image, and its visible share",
          {.columns = {"person", "x [m]", "y [m]", "z [m]", "yaw [rad]", "speaks", "u [px]",
                       "v [px]", "width [px]", "visible"}})),
      hand_joints_(module.output(
          "hand_joints", hc::table(),
          "truth, a row for each joint of each hand (0 left, 1 right), numbered as by MediaPipe: "
          "in "
          "the world and in the left image",
          {.columns = {"person", "hand", "joint", "x [m]", "y [m]", "z [m]", "u [px]", "v [px]"}})),
      pointed_(module.output("pointed", hc::table().of(1, 4),
                             "truth, while a person points: at which place in the world",
                             {.columns = {"person", "x [m]", "y [m]", "z [m]"}})) {}

void PeopleTruth::send(hc::Time time, const std::vector<hc::room::Person>& people,
                       const Eigen::Isometry3d& T_world_left,
                       const hc::graphics::PinholeCamera& camera) {
  if (people.empty()) return;
  if (people_.linked()) {
    auto draft = people_.loan(static_cast<std::int32_t>(people.size()), 10);
    draft.header.time = time;
    for (std::size_t i = 0; i < people.size(); ++i)
      std::ranges::copy(row_of(people, i, T_world_left, camera), draft.matrix().row(i).begin());
    people_.send(std::move(draft));
  }
  send_joints(time, people, T_world_left, camera);
  for (const auto& person : people)
    if (const auto& at = person.pointed)
      pointed_.send({double(person.number + 1), at->x(), at->y(), at->z()}, time);
}

void PeopleTruth::send_joints(hc::Time time, const std::vector<hc::room::Person>& people,
                              const Eigen::Isometry3d& T_world_left,
                              const hc::graphics::PinholeCamera& camera) {
  using hc::room::kHandJoints;
  if (!hand_joints_.linked()) return;
  const auto rows = static_cast<std::int32_t>(people.size() * 2 * kHandJoints);
  auto draft = hand_joints_.loan(rows, 8);
  draft.header.time = time;
  std::int32_t next = 0;
  for (const auto& person : people)
    for (const int side : {hc::room::kLeft, hc::room::kRight})
      for (int joint = 0; joint < kHandJoints; ++joint)
        std::ranges::copy(joint_row(person, side, joint, T_world_left, camera),
                          draft.matrix().row(next++).begin());
  hand_joints_.send(std::move(draft));
}
