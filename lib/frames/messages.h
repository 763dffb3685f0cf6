// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts messages to Eigen matrices and poses, and back. Header only. Pure.

#include <array>
#include <cstdint>
#include <string>

#include <frames/graph_frames.h>
#include <frames/rigid.h>
#include <hc/module/kind.h>

namespace hc {

/// A matrix of scalars in row-major order, as in messages.
template <typename T>
using RowMajor = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The elements as a matrix of `height` rows and `width × components` columns: a transformation as
/// it is, a list of positions of width 1 with one per row. A view of the message, which must
/// outlive it.
///
/// Errors: Unsupported (compressed; another scalar than T).
template <ScalarType T>
Result<Eigen::Map<const RowMajor<T>>> as_eigen(const Message& message) {
  auto matrix = HC_TRY(view<T>(message));
  return Eigen::Map<const RowMajor<T>>(
      matrix.numbers().data(), static_cast<Eigen::Index>(matrix.height()),
      static_cast<Eigen::Index>(matrix.width() * matrix.components()));
}

/// The elements of a draft, to write in place; T must be the draft's scalar.
template <ScalarType T>
Eigen::Map<RowMajor<T>> as_eigen(const Draft& draft) {
  auto matrix = view<T>(draft);
  return Eigen::Map<RowMajor<T>>(matrix.numbers().data(),
                                 static_cast<Eigen::Index>(matrix.height()),
                                 static_cast<Eigen::Index>(matrix.width() * matrix.components()));
}

/// A pose as the 16 numbers of a transformation, row by row: p_to = T_to_from · (x y z 1)ᵀ, lengths
/// in metres.
///
///     pose.send(hc::numbers_of(T_world_head), time);
inline std::array<double, 16> numbers_of(const Eigen::Isometry3d& T_to_from) {
  std::array<double, 16> numbers{};
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data()) = T_to_from.matrix();
  return numbers;
}

/// A rigid transformation from a message, for a joint of frames::Tree.
struct TimedPose {
  std::int32_t to = 0;    ///< target frame, the parent of a joint; 1 … 999
  std::int32_t from = 0;  ///< source frame, the child; 1 … 999
  Time time;              ///< Time{}: unknown
  Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();  ///< translation [m]
};

namespace internal {

template <ScalarType T>
Result<Eigen::Isometry3d> rigid_of(const Message& message) {
  auto matrix = HC_TRY(as_eigen<T>(message));
  return frames::rigid(matrix.template cast<double>());
}

}  // namespace internal

/// The 4 x 4 transformation in a message, f32 or f64, with any coord.
///
/// Errors: Unsupported (another matrix type or shape; compressed); Malformed (frames::rigid()).
inline Result<Eigen::Isometry3d> rigid_of(const Message& message) {
  const Header& header = message.header;
  if (header.info.type != MatrixType::Transformation || header.width != 4 || header.height != 4)
    return Error{Code::Unsupported, "a pose is a transformation 4 x 4, not " +
                                        matrix_text(header.info, header.width, header.height)};
  return header.info.scalar == Scalar::F32 ? internal::rigid_of<float>(message)
                                           : internal::rigid_of<double>(message);
}

/// The pose in a `transformation`: 4 rows of 4 numbers of f32 or f64, for column vectors, p_to =
/// T_to_from · (x y z 1)ᵀ, lengths in metres, frames in `coord` = 1000 · to + from (spec/mtp-1.md,
/// R44). The only matrix type for poses: a `position` is a point, and a `rotation` (see
/// rotation_of) only angles, and neither names the frame that it describes.
///
/// Errors: Unsupported (another matrix type or shape; compressed); Malformed (a coord that does not
/// name two frames; as frames::rigid()).
/// Cost: no allocation unless it fails.
inline Result<TimedPose> pose_of(const Message& message) {
  auto T_to_from = HC_TRY(rigid_of(message));
  const Header& header = message.header;
  if (header.coord / 1000 < 1 || header.coord / 1000 > 999 || header.coord % 1000 == 0)
    return Error{Code::Malformed,
                 "a pose's coord is 1000 x to + from, not " + std::to_string(header.coord)};
  return TimedPose{header.coord / 1000, header.coord % 1000, header.time, T_to_from};
}

/// Feeds a pose to the frame of a graph that its src and coord identify.
///
/// Errors: as GraphFrames::mover_of() (no such frame), rigid_of(), and Tree::feed() (an unknown
/// time); then nothing changes.
inline Result<frames::Fed> feed(frames::GraphFrames& frames, const Message& message) {
  auto mover = HC_TRY(frames.mover_of(message.header.src, message.header.coord));
  auto pose = HC_TRY(rigid_of(message));
  return frames.tree.feed(std::string_view(mover->parent), std::string_view(mover->child),
                          message.header.time, pose);
}

/// The rotation in a `rotation` of one element: roll φ, pitch θ, yaw ψ [rad], right-handed,
/// R = Rz(ψ) Ry(θ) Rx(φ) (see frames::rotation); ignores rates and accelerations. For the gaze
/// (coord 13), which is roll, tilt and pan, it rotates vectors from the head's frame to the
/// pan-tilt unit's: pan > 0 looks left, tilt > 0 looks down.
///
/// Errors: Unsupported (another type; several elements; compressed); Malformed (not finite).
inline Result<Eigen::Quaterniond> rotation_of(const Message& message) {
  const Header& header = message.header;
  if (header.info.type != MatrixType::Rotation || header.width != 1 || header.height != 1)
    return Error{Code::Unsupported, "expected one rotation, not " +
                                        matrix_text(header.info, header.width, header.height)};
  Eigen::Vector3d angles;
  if (header.info.scalar == Scalar::F32) {
    auto row = HC_TRY(as_eigen<float>(message));
    angles = row.template leftCols<3>().transpose().template cast<double>();
  } else {
    auto row = HC_TRY(as_eigen<double>(message));
    angles = row.template leftCols<3>().transpose();
  }
  if (!angles.allFinite()) return Error{Code::Malformed, "a rotation's angle is not finite"};
  return frames::rotation(angles.x(), angles.y(), angles.z());
}

}  // namespace hc
