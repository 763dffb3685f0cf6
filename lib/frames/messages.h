// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages as Eigen matrices and poses, and back. Header only. Pure.

#include <array>
#include <cstdint>
#include <string>

#include <frames/graph_frames.h>
#include <frames/rigid.h>
#include <hc/module/kind.h>

namespace hc {

/// Rows and columns of scalars, row by row as the format has them.
template <typename T>
using RowMajor = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The elements as a matrix of `height` rows and `width × components` columns: a transformation as
/// it is, a path of positions with a row for each when it has width 1. Views the message, which
/// must live longer.
///
/// Errors: Unsupported (compressed; another scalar than T).
template <ScalarType T>
Result<Eigen::Map<const RowMajor<T>>> as_eigen(const Message& message) {
  auto view = HC_TRY(message.view<T>());
  return Eigen::Map<const RowMajor<T>>(view.numbers().data(),
                                       static_cast<Eigen::Index>(view.height()),
                                       static_cast<Eigen::Index>(view.width() * view.components()));
}

/// The elements of a draft, to be written in place. Another scalar than the draft's is a bug.
template <ScalarType T>
Eigen::Map<RowMajor<T>> as_eigen(const Draft& draft) {
  auto view = draft.view<T>();
  return Eigen::Map<RowMajor<T>>(view.numbers().data(), static_cast<Eigen::Index>(view.height()),
                                 static_cast<Eigen::Index>(view.width() * view.components()));
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

/// A rigid transformation out of a message: a joint of frames::Tree takes all four.
struct TimedPose {
  std::int32_t to = 0;    ///< frame into which it takes points, the parent of a joint; 1 … 999
  std::int32_t from = 0;  ///< frame out of which it takes them, the child; 1 … 999
  std::int64_t time = 0;  ///< when it was so [ns since the Unix epoch]; 0: unknown
  Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();  ///< translation [m]
};

namespace internal {

template <ScalarType T>
Result<Eigen::Isometry3d> rigid_of(const Message& message) {
  auto matrix = HC_TRY(as_eigen<T>(message));
  return frames::rigid(matrix.template cast<double>());
}

}  // namespace internal

/// The transformation of 4 x 4 that a message carries, f32 or f64, whatever its coord.
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

/// The pose that a `transformation` carries: 4 rows of 4 numbers of f32 or f64, for column vectors,
/// p_to = T_to_from · (x y z 1)ᵀ, lengths in metres, frames in `coord` = 1000 · to + from
/// (spec/mtp-1.md, R44). It is the one matrix type that holds a pose: a `position` is a point, and
/// a `rotation` (see rotation_of) angles alone; neither says what it is that is there.
///
/// Errors: Unsupported (another matrix type or shape; compressed); Malformed (a coord that does not
/// name two frames; what frames::rigid() refuses).
/// Cost: no allocation unless it fails.
inline Result<TimedPose> pose_of(const Message& message) {
  auto T_to_from = HC_TRY(rigid_of(message));
  const Header& header = message.header;
  if (header.coord / 1000 < 1 || header.coord / 1000 > 999 || header.coord % 1000 == 0)
    return Error{Code::Malformed,
                 "a pose's coord is 1000 x to + from, not " + std::to_string(header.coord)};
  return TimedPose{header.coord / 1000, header.coord % 1000, header.time, T_to_from};
}

/// Hands a pose to the frames of a graph: to the one that its src and coord mean.
///
/// Errors: as GraphFrames::mover_of() (no frame is meant), pose_of() but for the coord of a frame
/// without a number, and Tree::feed() (a time of 0). Nothing changes then.
inline Result<frames::Fed> feed(frames::GraphFrames& frames, const Message& message) {
  auto mover = HC_TRY(frames.mover_of(message.header.src, message.header.coord));
  auto pose = HC_TRY(rigid_of(message));
  return frames.tree.feed(std::string_view(mover->parent), std::string_view(mover->child),
                          message.header.time, pose);
}

/// The rotation in a `rotation` of one element: roll φ, pitch θ, yaw ψ [rad], right-handed,
/// R = Rz(ψ) Ry(θ) Rx(φ) (see frames::rotation); rates and accelerations are ignored. Of the gaze
/// (coord 13), which is roll, tilt and pan, it turns vectors of the head into the pan-tilt unit's
/// frame: pan > 0 looks to the left, tilt > 0 looks down.
///
/// Errors: Unsupported (another matrix type or more than one element; compressed); Malformed (not
/// finite).
inline Result<Eigen::Quaterniond> rotation_of(const Message& message) {
  const Header& header = message.header;
  if (header.info.type != MatrixType::Rotation || header.width != 1 || header.height != 1)
    return Error{Code::Unsupported, "one rotation is asked for, not " +
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
