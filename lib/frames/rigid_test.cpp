// SPDX-License-Identifier: Apache-2.0
#include <frames/rigid.h>

#include <gtest/gtest.h>

#include <limits>

#include "random_motion_test.h"

namespace hc::frames {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

std::string refusal(const Eigen::Matrix4d& matrix) {
  auto result = rigid(matrix);
  if (result) return "";
  EXPECT_EQ(result.error().code, Code::Malformed);
  return result.error().detail;
}

TEST(Rigid, TakesARoundedMatrixAndGivesAnExactRotation) {
  RandomMotion random(1);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Matrix4d exact = random.transformation().matrix();
    Eigen::Matrix4d rounded = (exact * 1e4).array().round() / 1e4;
    auto result = rigid(rounded);
    ASSERT_TRUE(result) << exact;
    Eigen::Matrix3d r = result->linear();
    EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-15 * 4);
    EXPECT_LT((result->matrix() - exact).cwiseAbs().maxCoeff(), 2e-4);
    EXPECT_EQ(result->translation(), (rounded.topRightCorner<3, 1>()));
    EXPECT_LT((rigid(exact)->matrix() - exact).cwiseAbs().maxCoeff(), 2e-15);
  }
}

TEST(Rigid, RefusesWhatIsNot) {
  const Eigen::Matrix4d one = Eigen::Matrix4d::Identity();
  EXPECT_EQ(refusal(one), "");
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      for (double wrong : {kNan, kInfinity, -kInfinity}) {
        Eigen::Matrix4d matrix = one;
        matrix(row, column) = wrong;
        EXPECT_EQ(refusal(matrix), "frames: the transformation has a number that is not finite");
      }
  Eigen::Matrix4d projective = one, scaled = one, sheared = one, mirrored = one, huge = one;
  projective(3, 3) = 2;
  EXPECT_EQ(refusal(projective), "frames: the transformation has another last row than 0 0 0 1");
  scaled.topLeftCorner<3, 3>() *= 1.001;
  sheared(0, 1) = 0.01;
  huge(2, 2) = 1e200;
  for (const auto& matrix : {scaled, sheared, huge, Eigen::Matrix4d(one.col(3).asDiagonal())})
    EXPECT_NE(refusal(matrix).find("not rigid: its axes"), std::string::npos) << matrix;
  mirrored(1, 1) = -1;
  EXPECT_EQ(refusal(mirrored), "frames: the transformation is not rigid: it is a reflection");
}

TEST(Rigid, TakesAQuaternionOfAnyLengthAndEitherSign) {
  RandomMotion random(2);
  for (double length : {1e-320, 1e-200, 1e-3, 1.0, 7.0, 1e200, 1e308}) {
    Eigen::Isometry3d expected = random.transformation();
    Eigen::Quaterniond q(expected.linear());
    for (double sign : {1.0, -1.0}) {
      auto result = rigid(expected.translation(), Eigen::Quaterniond(q.coeffs() * sign * length));
      ASSERT_TRUE(result);
      double tolerance = length < 1e-300 ? 1e-2 : 4e-15;  // the smallest numbers have few digits
      EXPECT_LT((result->matrix() - expected.matrix()).norm(), tolerance) << length;
    }
  }
}

TEST(Rigid, RefusesAQuaternionThatIsNone) {
  const Eigen::Vector3d origin(0, 0, 0);
  auto zero = rigid(origin, Eigen::Quaterniond(0, 0, 0, 0));
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().text(), "Malformed: frames: the transformation has a quaternion of zeros");
  EXPECT_FALSE(rigid(origin, Eigen::Quaterniond(1, kNan, 0, 0)));
  EXPECT_FALSE(rigid(origin, Eigen::Quaterniond(kInfinity, 0, 0, 0)));
  EXPECT_FALSE(rigid(Eigen::Vector3d(0, kNan, 0), Eigen::Quaterniond::Identity()));
}

TEST(Rotation, TurnsLeftLooksDownLowersTheRight) {
  const Eigen::Vector3d forward(1, 0, 0), left(0, 1, 0), up(0, 0, 1);
  EXPECT_TRUE((rotation(0, 0, kPi / 2) * forward).isApprox(left));
  EXPECT_TRUE((rotation(0, kPi / 2, 0) * forward).isApprox(-up));
  EXPECT_TRUE((rotation(kPi / 2, 0, 0) * -left).isApprox(-up));
}

TEST(Rotation, IsRollThenPitchThenYawAboutAxesThatStandStill) {
  RandomMotion random(3);
  for (int i = 0; i < 100; ++i) {
    double roll = random.number(-4, 4), pitch = random.number(-4, 4), yaw = random.number(-4, 4);
    Eigen::Matrix3d expected =
        turn({0, 0, 1}, yaw) * turn({0, 1, 0}, pitch) * turn({1, 0, 0}, roll);
    EXPECT_LT((rotation(roll, pitch, yaw).toRotationMatrix() - expected).norm(), 4e-15);
  }
}

TEST(Between, IsAsAxisAndAngleSay) {
  RandomMotion random(4);
  for (int i = 0; i < 2000; ++i) {
    Eigen::Isometry3d a = random.transformation(), b = random.transformation();
    if (i % 2 == 0)  // close to one another, as in a motion
      b = Eigen::AngleAxisd(random.number(0, 1e-3), random.vector(1).normalized()) * a;
    double share = random.number(0, 1);
    Pose pose_a(a), pose_b(b);
    if (i % 3 == 0) pose_b.q.coeffs() *= -1;  // the same rotation
    Eigen::Matrix4d got = between(pose_a, pose_b, share).transformation().matrix();
    EXPECT_LT((got - interpolated(a.matrix(), b.matrix(), share)).norm(), 1e-9) << i;
  }
}

TEST(Between, ReachesBothEndsAndStaysOfLengthOne) {
  RandomMotion random(5);
  for (int i = 0; i < 200; ++i) {
    Pose a(random.transformation()), b(random.transformation());
    EXPECT_EQ(between(a, b, 0).p, a.p);
    EXPECT_EQ(between(a, b, 0).q.coeffs(), a.q.coeffs());
    EXPECT_EQ(between(a, b, 1).p, b.p);
    EXPECT_EQ(between(a, b, 1).q.coeffs(), b.q.coeffs());
    Pose middle = between(a, b, random.number(0, 1));
    EXPECT_NEAR(middle.q.norm(), 1, 4e-16);
    // Symmetric, and the shorter way: no farther from either end than the ends are apart.
    EXPECT_LE(a.q.angularDistance(middle.q), a.q.angularDistance(b.q) + 1e-7);
  }
}

TEST(Between, TakesTheShorterWayAcrossHalfATurn) {
  Pose a, b;
  a.q = rotation(0, 0, kPi - 0.1);
  b.q = rotation(0, 0, -kPi + 0.1);
  EXPECT_NEAR(between(a, b, 0.5).q.angularDistance(rotation(0, 0, kPi)), 0, 1e-7);
  b.q = rotation(0, 0, -0.1);  // exactly half a turn: either way, but a rotation
  EXPECT_NEAR(between(a, b, 0.5).q.norm(), 1, 4e-16);
  EXPECT_NEAR(between(a, b, 0.5).q.angularDistance(a.q), kPi / 2, 1e-7);
}

TEST(Angles, AreThoseOfTheRotation) {
  RandomMotion random(8);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d R = random.transformation().linear();
    const auto angles = angles_of(R);
    EXPECT_TRUE(rotation(angles.x(), angles.y(), angles.z()).matrix().isApprox(R, 1e-12));
  }
  for (double pitch : {M_PI / 2, -M_PI / 2}) {
    const Eigen::Matrix3d R = rotation(0.3, pitch, 0.5).matrix();
    const auto angles = angles_of(R);
    EXPECT_TRUE(rotation(angles.x(), angles.y(), angles.z()).matrix().isApprox(R, 1e-7));
  }
}

}  // namespace
}  // namespace hc::frames
