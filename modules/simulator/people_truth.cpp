// SPDX-License-Identifier: Apache-2.0
#include "people_truth.h"

#include <array>
#include <cmath>

#include <room/face_shape.h>
#include <room/hand_model.h>
#include <room/person_seen.h>

using hc::room::JointColumns;
using hc::room::PersonColumns;
using hc::room::PointedColumns;

hc::room::PersonRow row_of(std::span<const hc::room::Person> people, std::size_t index,
                           const Eigen::Isometry3d& T_world_eye,
                           const hc::graphics::PinholeCamera& camera) {
  const auto& person = people[index];
  const Eigen::Vector3d ahead = person.T_world_face.linear().col(0);
  hc::room::PersonRow row{.person = person.number + 1,
                          .p_world = person.T_world_face.translation(),
                          .yaw = std::atan2(ahead.y(), ahead.x()),
                          .speaks = person.speaks};
  const Eigen::Isometry3d T_eye_world = T_world_eye.inverse();
  const Eigen::Vector3d p_eye = T_eye_world * row.p_world;
  if (p_eye.z() <= camera.near) return row;
  row.pixel = camera.project(p_eye);
  row.width = camera.fx * hc::room::kFaceWidth * hc::room::look_of(person.number).wide / p_eye.z();
  const auto is_in_view = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = T_eye_world * point;
    return at.z() > camera.near && camera.contains(camera.project(at));
  };
  row.visible = hc::room::face_seen(people, index, T_world_eye.translation(), is_in_view);
  return row;
}

hc::room::JointRow joint_row(const hc::room::Person& person, int side, int joint,
                             const Eigen::Isometry3d& T_world_eye,
                             const hc::graphics::PinholeCamera& camera) {
  const auto& hand = person.hands[static_cast<std::size_t>(side)];
  hc::room::JointRow row{person.number + 1, side, joint};
  row.p_world =
      hand.T_world_wrist * hc::room::hand_joints(side, hand.sign)[static_cast<std::size_t>(joint)];
  const Eigen::Vector3d p_eye = T_world_eye.inverse() * row.p_world;
  if (p_eye.z() > camera.near) row.pixel = camera.project(p_eye);
  return row;
}

PeopleTruth::PeopleTruth(hc::Module& module)
    : people_(module.output(
          "people", hc::table(),
          "truth, a row for each person: between the eyes in the world and in the left image; yaw "
          "of the face in the world; its width in the image, and its visible share",
          {.columns = hc::column_names<PersonColumns, hc::room::PersonRow>()})),
      hand_joints_(module.output(
          "hand_joints", hc::table(),
          "truth, a row for each joint of each hand (0 left, 1 right), numbered as by MediaPipe: "
          "in the world and in the left image",
          {.columns = hc::column_names<JointColumns, hc::room::JointRow>()})),
      pointed_(
          module.output("pointed", hc::table().of(1, hc::room::kPointedColumns),
                        "truth, while a person points: at which place in the world",
                        {.columns = hc::column_names<PointedColumns, hc::room::PointedRow>()})) {}

void PeopleTruth::send(hc::Time time, const std::vector<hc::room::Person>& people,
                       const Eigen::Isometry3d& T_world_left,
                       const hc::graphics::PinholeCamera& camera) {
  if (people.empty()) return;
  if (people_.linked()) {
    auto draft = people_.loan(static_cast<std::int32_t>(people.size()), hc::room::kPersonColumns);
    draft.header.time = time;
    for (std::size_t i = 0; i < people.size(); ++i)
      hc::write_row<PersonColumns>(row_of(people, i, T_world_left, camera), draft.matrix().row(i));
    people_.send(std::move(draft));
  }
  send_joints(time, people, T_world_left, camera);
  for (const auto& person : people)
    if (person.pointed) {
      std::array<double, hc::room::kPointedColumns> row{};
      hc::write_row<PointedColumns>(hc::room::PointedRow{person.number + 1, *person.pointed}, row);
      pointed_.send(row, time);
    }
}

void PeopleTruth::send_joints(hc::Time time, const std::vector<hc::room::Person>& people,
                              const Eigen::Isometry3d& T_world_left,
                              const hc::graphics::PinholeCamera& camera) {
  if (!hand_joints_.linked()) return;
  const auto rows = static_cast<std::int32_t>(people.size() * 2 * hc::room::kHandJoints);
  auto draft = hand_joints_.loan(rows, hc::room::kJointColumns);
  draft.header.time = time;
  std::int32_t next = 0;
  for (const auto& person : people)
    for (const int side : {hc::room::kLeft, hc::room::kRight})
      for (int joint = 0; joint < hc::room::kHandJoints; ++joint)
        hc::write_row<JointColumns>(joint_row(person, side, joint, T_world_left, camera),
                                    draft.matrix().row(next++));
  hand_joints_.send(std::move(draft));
}
