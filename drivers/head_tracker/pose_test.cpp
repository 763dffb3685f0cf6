// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/pose.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace {

using hc::HeadPose;
using hc::read_head_packet;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kClose = 1e-12;  // a few rounding errors of numbers around 1

std::array<std::byte, 48> packet(const std::array<double, 6>& numbers) {
  std::array<std::byte, 48> bytes{};
  for (std::size_t i = 0; i < 48; ++i)
    bytes[i] = std::byte(std::bit_cast<std::uint64_t>(numbers[i / 8]) >> (8 * (i % 8)) & 0xFF);
  return bytes;
}

HeadPose pose(double x, double y, double z, double yaw, double pitch, double roll) {
  auto read = read_head_packet(packet({x, y, z, yaw, pitch, roll}));
  EXPECT_TRUE(read);
  return *read;
}

TEST(HeadPacket, known_bytes) {
  // 1.0 is 0x3FF0000000000000, little-endian.
  std::array<std::byte, 48> bytes{};
  bytes[6] = std::byte(0xF0);
  bytes[7] = std::byte(0x3F);
  EXPECT_NEAR(read_head_packet(bytes)->p.y(), -0.01, kClose);
}

TEST(HeadPacket, signs_are_those_of_a_body) {
  EXPECT_TRUE(pose(10, 20, 30, 0, 0, 0).p.isApprox(Eigen::Vector3d(-0.3, -0.1, 0.2), kClose));
  EXPECT_TRUE(pose(0, 0, 0, -30, 0, 0).angles().isApprox(Eigen::Vector3d(0, 0, 30 * kDegree)));
  EXPECT_TRUE(pose(0, 0, 0, 0, -20, 0).angles().isApprox(Eigen::Vector3d(0, 20 * kDegree, 0)));
  EXPECT_TRUE(pose(0, 0, 0, 0, 0, 10).angles().isApprox(Eigen::Vector3d(10 * kDegree, 0, 0)));
  // Looking to the right and up: forward has y < 0 and z > 0. Tilted to the right: the left ear is
  // up.
  const Eigen::Vector3d forward = pose(0, 0, 0, 30, 20, 0).R * Eigen::Vector3d::UnitX();
  EXPECT_LT(forward.y(), -0.1);
  EXPECT_GT(forward.z(), 0.1);
  EXPECT_GT((pose(0, 0, 0, 0, 0, 10).R * Eigen::Vector3d::UnitY()).z(), 0.1);
}

TEST(HeadPacket, angles_come_back_as_they_were) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-89, 89);
  for (int i = 0; i < 1000; ++i) {
    const double yaw = 2 * any(random), pitch = any(random), roll = 2 * any(random);
    const Eigen::Vector3d expected = Eigen::Vector3d(roll, -pitch, -yaw) * kDegree;
    EXPECT_LT((pose(0, 0, 0, yaw, pitch, roll).angles() - expected).norm(), 1e-9);
  }
}

TEST(HeadPacket, refuses_what_is_no_pose) {
  const double wrong[] = {std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity(), 1e300, -1e6,
                          // In big-endian order: 10, 0.5 and 0.1f.
                          4.6e-320, 1.12e-319, 2.5e-305, -1e-31, 2001};
  for (double number : wrong)
    for (std::size_t at = 0; at < 6; ++at) {
      std::array<double, 6> numbers = {1, 2, 3, 4, 5, 6};
      EXPECT_TRUE(read_head_packet(packet(numbers)));
      numbers[at] = number;
      EXPECT_FALSE(read_head_packet(packet(numbers))) << number << " at " << at;
    }
  for (double degrees : {360.1, -361.0})
    EXPECT_FALSE(read_head_packet(packet({0, 0, 0, 0, degrees, 0})));
  for (double degrees : {360.0, -180.0, 0.0, -0.0, 1e-17})
    EXPECT_TRUE(read_head_packet(packet({0, 0, 0, degrees, 0, 0})));
  const auto whole = packet({1, 2, 3, 4, 5, 6});
  for (std::size_t size = 0; size < 48; ++size)
    EXPECT_FALSE(read_head_packet(std::span(whole).first(size)));
  EXPECT_FALSE(read_head_packet(std::array<std::byte, 49>{}));
}

TEST(HeadPose, relative_to_where_it_was_zeroed) {
  const HeadPose zero = pose(10, 20, 30, -90, 0, 0);  // looks to the left
  EXPECT_LT(zero.relative_to(zero).angles().norm(), kClose);
  EXPECT_LT(zero.relative_to(zero).p.norm(), kClose);
  // The head looked to the tracker's left, so 0.1 m in that direction is forward.
  const HeadPose moved = pose(0, 20, 30, -120, 0, 0).relative_to(zero);
  EXPECT_LT((moved.p - Eigen::Vector3d(0.1, 0, 0)).norm(), kClose);
  EXPECT_LT((moved.angles() - Eigen::Vector3d(0, 0, 30 * kDegree)).norm(), kClose);
}

TEST(HeadPose, turns_on_over_half_a_turn) {
  const HeadPose zero = pose(0, 0, 0, 170, 0, 0);
  EXPECT_NEAR(pose(0, 0, 0, -170, 0, 0).relative_to(zero).angles().z(), -20 * kDegree, kClose);
}

TEST(HeadPacket, what_is_written_is_read_as_the_same) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  for (int i = 0; i < 1000; ++i) {
    using Turn = Eigen::AngleAxisd;
    const HeadPose pose{(Turn(2 * any(random), Eigen::Vector3d::UnitZ()) *
                         Turn(any(random), Eigen::Vector3d::UnitY()) *
                         Turn(2 * any(random), Eigen::Vector3d::UnitX()))
                            .toRotationMatrix(),
                        {any(random), any(random), any(random)}};
    const auto read = read_head_packet(hc::write_head_packet(pose));
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->R.isApprox(pose.R, 1e-9));
    EXPECT_TRUE(read->p.isApprox(pose.p, 1e-9));
  }
}

TEST(HeadPacket, is_written_as_opentrack_does) {
  // One metre up is y = 100 cm, the second number: 0x4059000000000000.
  const auto packet = hc::write_head_packet({Eigen::Matrix3d::Identity(), {0, 0, 1}});
  EXPECT_EQ(packet[15], std::byte(0x40));
  EXPECT_EQ(packet[14], std::byte(0x59));
  EXPECT_EQ(packet[13], std::byte(0));
}

}  // namespace
