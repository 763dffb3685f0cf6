// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a head tracker says in a packet, and where the head is by it. Pure.
//
// opentrack's packet has 48 bytes: six little-endian f64, x y z [cm], yaw pitch roll [°]. What they
// mean is known from what opentrack does with them (its plugin for X-Plane, whose frame is known):
// x > 0 is to the person's right, y > 0 up, z > 0 back, away from the screen; yaw > 0 turns right,
// pitch > 0 looks up, roll > 0 tilts the head to the right shoulder. A tracker that is set up
// otherwise is put right in opentrack, where each axis can be inverted.
//
// Ours is the frame of a body (spec/mtp-1.md, R44): x forward, y left, z up [m]; roll φ, pitch θ,
// yaw ψ [rad], R = Rz(ψ) Ry(θ) Rx(φ). So yaw > 0 turns left and pitch > 0 looks down, as gaze does.

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Geometry>

#include <hc/base/result.h>

namespace hc {

inline constexpr std::size_t kHeadPacketBytes = 48;

/// Where a head is: takes points in the head's frame to points in the tracker's.
struct HeadPose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]

  /// The same as seen from another pose: where `zero` looks is forward.
  [[nodiscard]] HeadPose relative_to(const HeadPose& zero) const;
  /// roll, pitch, yaw [rad]; pitch from −π/2 to π/2, the others from −π to π.
  [[nodiscard]] Eigen::Vector3d angles() const;
};

/// Reads a packet of opentrack.
///
/// Errors: Malformed (another size, a number that is not finite, or that no head has: above 20 m or
/// 360°, or not 0 but below 1e-30, as big-endian numbers are).
Result<HeadPose> read_head_packet(std::span<const std::byte> packet);

/// The packet that opentrack sends of a pose: what read_head_packet() reads as the same.
std::array<std::byte, kHeadPacketBytes> write_head_packet(const HeadPose& pose);

}  // namespace hc
