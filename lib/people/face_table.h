// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rows of the table `faces` of module faces. Pure.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <people/face.h>

namespace hc::people {

/// A face of a row.
struct FaceRow {
  Face face;
  int track = 0;                                    ///< from 1
  int person = 0;                                   ///< 0: unknown
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< between the eyes, in the head's frame [m]
};

inline constexpr std::int32_t kFaceColumns = 24;
/// Their names, with units.
std::vector<std::string> face_columns();

/// @param[out] row  of kFaceColumns numbers.
void write(const FaceRow& face, std::span<double> row);
/// Whether a head can be in a place: 0.1 … 100 m from the robot's.
bool can_be_face(const Eigen::Vector3d& p_head);
/// The face of a row; nothing if it has too few numbers, or some that no face has: NaN, a track
/// that is no whole number.
std::optional<FaceRow> face_in(std::span<const double> row);

}  // namespace hc::people
