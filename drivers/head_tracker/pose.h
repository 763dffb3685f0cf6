// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads and writes the packets of a head tracker. Pure.
//
// An opentrack packet has 48 bytes: six little-endian f64, x y z [cm], yaw pitch roll [°]. Their
// signs follow from opentrack's plugin for X-Plane, whose frame is known: x > 0 is to the person's
// right, y > 0 up, z > 0 back, away from the screen; yaw > 0 turns right, pitch > 0 looks up, roll
// > 0 tilts the head to the right shoulder. If a tracker differs, invert axes in opentrack.
//
// Ours is the frame of a body (spec/mtp-1.md, R44): x forward, y left, z up [m]; roll φ, pitch θ,
// yaw ψ [rad], R = Rz(ψ) Ry(θ) Rx(φ). So yaw > 0 turns left and pitch > 0 looks down, as in gaze.

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Geometry>

#include <hc/base/result.h>

namespace hc {

inline constexpr std::size_t kHeadPacketBytes = 48;

/// Pose of a head: transforms points from the head's frame to the tracker's.
struct HeadPose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]

  /// This pose in the frame of `zero`, whose line of sight is forward.
  [[nodiscard]] HeadPose relative_to(const HeadPose& zero) const;
  /// roll, pitch, yaw [rad]; pitch from −π/2 to π/2, the others from −π to π.
  [[nodiscard]] Eigen::Vector3d angles() const;
};

/// Reads an opentrack packet.
///
/// Errors: Malformed (wrong size; a number that is not finite, above 20 m or 360°, or not 0 but
/// below 1e-30, as big-endian numbers are).
Result<HeadPose> read_head_packet(std::span<const std::byte> packet);

/// Writes a pose as an opentrack packet; the inverse of read_head_packet().
std::array<std::byte, kHeadPacketBytes> write_head_packet(const HeadPose& pose);

}  // namespace hc
