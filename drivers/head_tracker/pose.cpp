// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/pose.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <hc/base/format.h>

namespace hc {
namespace {

// The size of a room, and a full turn each way; an inverted axis of opentrack can give 360°.
constexpr double kMostCentimetres = 2000, kMostDegrees = 360;
// Below any measurement noise, but above big-endian doubles: 10 reads as 4.6e-320.
constexpr double kLeast = 1e-30;
constexpr const char* kNames[] = {"x", "y", "z", "yaw", "pitch", "roll"};

double little_endian(std::span<const std::byte> bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
  return std::bit_cast<double>(bits);
}

Eigen::Matrix3d turned(double roll, double pitch, double yaw) {
  using Turn = Eigen::AngleAxisd;
  return (Turn(yaw, Eigen::Vector3d::UnitZ()) * Turn(pitch, Eigen::Vector3d::UnitY()) *
          Turn(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

HeadPose HeadPose::relative_to(const HeadPose& zero) const {
  return {zero.R.transpose() * R, zero.R.transpose() * (p - zero.p)};
}

Eigen::Vector3d HeadPose::angles() const {
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

Result<HeadPose> read_head_packet(std::span<const std::byte> packet) {
  if (packet.size() != kHeadPacketBytes)
    return Error{Code::Malformed, "a packet of " + std::to_string(packet.size()) + " bytes, not " +
                                      std::to_string(kHeadPacketBytes)};
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = little_endian(packet.subspan(8 * i, 8));
    const double size = std::abs(numbers[i]);
    // Written so that NaN fails, too.
    if (!(size <= (i < 3 ? kMostCentimetres : kMostDegrees)) || (size > 0 && size < kLeast))
      return Error{Code::Malformed, hc::format("a packet whose {} is {}{}", kNames[i], numbers[i],
                                               size < kLeast ? ", probably big-endian" : "")};
  }
  const auto [x, y, z, yaw, pitch, roll] = numbers;
  constexpr double kRadians = std::numbers::pi / 180, kMetres = 0.01;
  return HeadPose{turned(roll * kRadians, -pitch * kRadians, -yaw * kRadians),
                  Eigen::Vector3d(-z, -x, y) * kMetres};
}

std::array<std::byte, kHeadPacketBytes> write_head_packet(const HeadPose& pose) {
  constexpr double kDegrees = 180 / std::numbers::pi, kCentimetres = 100;
  const Eigen::Vector3d angles = pose.angles() * kDegrees, p = pose.p * kCentimetres;
  const std::array<double, 6> numbers = {-p.y(),      p.z(),       -p.x(),
                                         -angles.z(), -angles.y(), angles.x()};
  std::array<std::byte, kHeadPacketBytes> packet{};
  for (std::size_t i = 0; i < packet.size(); ++i)
    packet[i] = std::byte((std::bit_cast<std::uint64_t>(numbers[i / 8]) >> (8 * (i % 8))) & 0xFF);
  return packet;
}

}  // namespace hc
