// SPDX-License-Identifier: Apache-2.0
#include <frames/messages.h>

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include <frames/tree.h>
#include <hc/mtp/matrix_view.h>
#include <hc/testing/decode.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

Message message_of(std::string_view bytes) {
  Message message;
  auto used = decode(std::as_bytes(std::span(bytes)), message);
  EXPECT_TRUE(used && *used == bytes.size()) << bytes;
  return message.keep();
}

// A head turned 90° to the left, 0.3 m above its robot, as typed by hand.
constexpr std::string_view kHeadPose =
    "1 7 0 0 8 1763683200123456789 70190 1 2003 4 4\n"
    "0 -1 0 0\n1 0 0 0\n0 0 1 0.3\n0 0 0 1\n";

std::string refusal(std::string_view from, std::string_view to) {
  std::string bytes(kHeadPose);
  bytes.replace(bytes.find(from), from.size(), to);
  auto pose = pose_of(message_of(bytes));
  return pose ? "" : pose.error().text();
}

TEST(Pose, IsATransformationOfFourByFour) {
  for (std::string_view info : {"70190", "70180"}) {
    std::string bytes(kHeadPose);
    bytes.replace(bytes.find("70190"), 5, info);
    auto pose = must(pose_of(message_of(bytes)));
    EXPECT_EQ(pose.to, 2);
    EXPECT_EQ(pose.from, 3);
    EXPECT_EQ(pose.time, unix_time(1763683200123456789));
    Eigen::Vector3d p_robot = pose.T_to_from * Eigen::Vector3d(1, 0, 0);
    EXPECT_LT((p_robot - Eigen::Vector3d(0, 1, 0.3)).norm(), 1e-7);
  }
}

TEST(Pose, FeedsATree) {
  auto tree = frames::Tree::standard();
  ASSERT_TRUE(tree.join("robot", "head"));
  auto pose = *pose_of(message_of(kHeadPose));
  ASSERT_TRUE(tree.feed(pose.to, pose.from, pose.time, pose.T_to_from));
  auto T_robot_head = tree.lookup("robot", "head", pose.time);
  EXPECT_EQ(T_robot_head->matrix(), pose.T_to_from.matrix());
}

TEST(Pose, FeedsTheFramesOfAGraph) {
  auto frames = *frames::read_frames("head 3 robot neck.pose 9; chip 0 head neck.chip 12");
  Message message = message_of(kHeadPose);
  const Time time = message.header.time;
  ASSERT_TRUE(feed(frames, message));
  EXPECT_TRUE(frames.tree.lookup("robot", "head", time));
  message.header.coord = 4;
  EXPECT_EQ(feed(frames, message).error().text(),
            "NotFound: frames: no frame is moved by messages from 7 with coord 4");
  message.header.src = 12;
  ASSERT_TRUE(feed(frames, message)) << "no coord is wanted of who has no number";
  EXPECT_TRUE(frames.tree.lookup("robot", "chip", time));
  message.header.time = {};
  EXPECT_EQ(feed(frames, message).error().text(),
            "Malformed: frames: chip in head is fed without a time");
  message.header.width = 1;
  EXPECT_EQ(feed(frames, message).error().code, Code::Unsupported);
}

TEST(Pose, RefusesWhatIsNone) {
  EXPECT_EQ(refusal("4 4\n0 -1 0 0\n1 0 0 0\n0 0 1 0.3\n", "4 1\n"),
            "Unsupported: a pose is a transformation 4 x 4, not transformation 4 x 1 of 1 x f64");
  EXPECT_EQ(refusal("70190", "120190"),
            "Unsupported: a pose is a transformation 4 x 4, not table 4 x 4 of 1 x f64");
  for (std::string_view coord : {"0", "3", "2000", "1000003", "2147483647"})
    EXPECT_EQ(refusal("2003", coord),
              "Malformed: a pose's coord is 1000 x to + from, not " + std::string(coord));
  EXPECT_EQ(refusal("0.3", "nan"),
            "Malformed: frames: the transformation has a number that is not finite");
  EXPECT_EQ(refusal("0 0 0 1", "0 0 0 2"),
            "Malformed: frames: the transformation has another last row than 0 0 0 1");
  EXPECT_EQ(refusal("-1", "1"),
            "Malformed: frames: the transformation is not rigid: it is a reflection");
  Message packed = message_of(kHeadPose);
  packed.header.info.encoding = Encoding::Zstd;
  EXPECT_EQ(pose_of(packed).error().code, Code::Unsupported);
}

TEST(Rotation, IsRollPitchYaw) {
  for (std::string_view info : {"20390", "20380", "20690"}) {
    std::string rates = info == "20690" ? " 9 9 9" : "";
    auto q = must(rotation_of(
        message_of("1 7 0 0 8 1 " + std::string(info) + " 1 13 1 1\n0 0.25 1.5" + rates + "\n")));
    Eigen::Vector3d looks = q * Eigen::Vector3d(1, 0, 0);  // left, and down
    Eigen::Vector3d expected(std::cos(0.25) * std::cos(1.5), std::cos(0.25) * std::sin(1.5),
                             -std::sin(0.25));
    EXPECT_LT((looks - expected).norm(), 1e-15);
  }
}

TEST(Rotation, RefusesWhatIsNone) {
  auto refused = [](std::string_view bytes) {
    return rotation_of(message_of(bytes)).error().text();
  };
  EXPECT_EQ(refused("1 7 0 0 8 1 10390 1 13 1 1\n0 0 0\n"),
            "Unsupported: expected one rotation, not position 1 x 1 of 3 x f64");
  EXPECT_EQ(refused("1 7 0 0 8 1 20390 1 13 1 0\n\n"),
            "Unsupported: expected one rotation, not rotation 1 x 0 of 3 x f64");
  EXPECT_EQ(refused("1 7 0 0 8 1 20390 1 13 1 1\n0 inf 0\n"),
            "Malformed: a rotation's angle is not finite");
}

TEST(Eigen, SharesATransformation) {
  Draft draft = Draft::make({MatrixType::Transformation, 1, Scalar::F64, Encoding::Text}, 3, 4);
  auto made = as_eigen<double>(draft);
  ASSERT_EQ(made.rows(), 3);
  ASSERT_EQ(made.cols(), 4);
  made.setZero();
  made(2, 3) = 5;
  Message message = std::move(draft).finish();
  auto seen = must(as_eigen<double>(message));
  EXPECT_EQ(static_cast<const void*>(seen.data()), message.elements.data());
  EXPECT_EQ((seen)(2, 3), 5);
  EXPECT_EQ(view<double>(message)->at(2, 3), 5);
  EXPECT_FALSE(as_eigen<float>(message));
}

TEST(Eigen, APathHasARowForEachPosition) {
  Draft draft = Draft::make(Info(), 5, 1);
  EXPECT_EQ(as_eigen<double>(draft).rows(), 5);
  EXPECT_EQ(as_eigen<double>(draft).cols(), 3);
}

TEST(Eigen, APoseGivesItsNumbers) {
  Eigen::Isometry3d T_world_head(Eigen::Translation3d(1, 2, 3) * frames::rotation(0, 0, 1.5));
  const auto kind = transformation().in(transform_coord(Coord::kWorld, Coord::kHead));
  const auto message = kind.message(numbers_of(T_world_head));
  EXPECT_LT((pose_of(message)->T_to_from.matrix() - T_world_head.matrix()).norm(), 1e-15);
  EXPECT_EQ(message.matrix().at(1, 3), 2);
  const auto q = *rotation_of(rotation().message({0, 0, 1.5}));
  EXPECT_LT(q.angularDistance(frames::rotation(0, 0, 1.5)), 1e-12);
}

}  // namespace
}  // namespace hc
