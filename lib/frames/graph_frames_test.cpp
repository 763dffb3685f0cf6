// SPDX-License-Identifier: Apache-2.0
#include <frames/graph_frames.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "random_motion_test.h"

#include <hc/testing/must.h>

namespace hc::frames {
namespace {

constexpr const char* kHead =
    "left_eye 4 head 0 0.5 0 0 0 0 1; head 3 robot neck.pose 11; nose 200 head 1 0 0 1 0 0 0; "
    "chip 0 left_eye camera.left 12";

std::string refusal(std::string_view text) {
  auto frames = read_frames(text);
  return frames ? "" : frames.error().text();
}

TEST(GraphFrames, AreATree) {
  auto frames = must(read_frames(kHead));
  auto T_nose_left_eye = must(frames.tree.lookup("nose", "left_eye", {}));
  // Half a turn about x, 1 m ahead.
  EXPECT_TRUE((T_nose_left_eye * Eigen::Vector3d(2, 0, 0)).isApprox(Eigen::Vector3d(1, -0.5, 0)));
  EXPECT_TRUE(frames.tree.lookup(200, 4, {})) << "by number";
  EXPECT_FALSE(frames.tree.lookup(2, 3, unix_time(100))) << "not fed";
  ASSERT_TRUE(frames.tree.feed("robot", "head", unix_time(100), Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(frames.tree.lookup(2, 3, unix_time(100)));
}

TEST(GraphFrames, AnEmptyTextHasNone) {
  for (const char* text : {"", "  "}) {
    auto frames = must(read_frames(text));
    EXPECT_TRUE(frames.movers.empty());
    EXPECT_FALSE(frames.tree.lookup("world", "world", {}));
  }
}

TEST(GraphFrames, MessagesTellWhomTheyMove) {
  auto frames = must(read_frames(std::string(kHead) + "; board 201 robot tracker.poses 13"));
  auto moved = [&](std::int32_t source, std::int32_t coord) {
    auto mover = frames.mover_of(source, coord);
    return mover ? (*mover)->parent + " " + (*mover)->child : mover.error().detail;
  };
  EXPECT_EQ(moved(11, 2003), "robot head");
  EXPECT_EQ(moved(0, 2003), "robot head") << "from nobody knows where";
  EXPECT_EQ(moved(77, 2003), "robot head") << "passed on, with the src that it began with";
  EXPECT_EQ(moved(13, 2003), "frames: no frame is moved by messages from 13 with coord 2003");
  EXPECT_EQ(moved(13, 2201), "robot board");
  EXPECT_EQ(moved(11, 2201), "frames: no frame is moved by messages from 11 with coord 2201");
  EXPECT_EQ(moved(12, 4777), "left_eye chip") << "which has no number";
  EXPECT_EQ(moved(77, 4777), "frames: no frame is moved by messages from 77 with coord 4777");
}

TEST(GraphFrames, ErrorsNameTheFrameAndWhatWouldBeRight) {
  const std::pair<const char*, const char*> malformed[] = {
      {"hello", "frame 1: \"hello\" has 1 words, not 5 (moved) or 10 (fixed)"},
      {"a 0 b c.d 1; ; e 0 a f.g 2", "frame 2: \"\" has 0 words, not 5 (moved) or 10 (fixed)"},
      {"a 0 b\n 0 0 0 0 0 0 1", "frame 1: \"b\\n\" is not a valid word"},
      {"a x b c.d 1", "frame 1, a: a frame's number is from 0 (none) to 999, not \"x\""},
      {"a 1000 b c.d 1", "frame 1, a: a frame's number is from 0 (none) to 999, not \"1000\""},
      {"head 5 b c.d 1", "frame 1, head: its number is 3, not 5"},
      {"nose 3 b c.d 1", "frame 1, nose: the number 3 is that of head"},
      {"a 0 b 1 2 3 0 0 0 x", "frame 1, a: \"x\" is not a number"},
      {"a 0 b 1 2 inf 0 0 0 1", "frame 1, a: \"inf\" is not a number"},
      {"a 0 b 1 2 3 0 0 1 1", "frame 1, a: its quaternion is not of length 1"},
      {"a 0 b c 1", "frame 1, a: \"c\" is not MODULE.PORT"},
      {"a 0 b c. 1", "frame 1, a: \"c.\" is not MODULE.PORT"},
      {"a 0 b .d 1", "frame 1, a: \".d\" is not MODULE.PORT"},
      {"a 0 b c.d.e 1", "frame 1, a: \"c.d.e\" is not MODULE.PORT"},
      {"a 0 b c.d -1", "frame 1, a: \"-1\" is not a src"},
      {"head 3 robot c.d 1; nose 0 haed c.e 2",
       "frame 2, nose: no frame \"haed\", did you mean \"head\"?; the root is robot"},
      {"a 0 b c.d 1; e 0 b c.d 1",
       "a and e are moved by messages of the src 1, so they and their parents need numbers"}};
  for (const auto& [text, wrong] : malformed)
    EXPECT_EQ(refusal(text), "Malformed: frames: " + std::string(wrong));
  const std::pair<const char*, const char*> invalid[] = {
      {"a 0 b c.d 1; a 0 b c.e 2", "frame 2, a: there is a frame a already"},
      {"a 100 b c.d 1; c 100 b c.e 2", "frame 2, c: frame 100 is a already"},
      {"a 0 a c.d 1", "frame 1, a: a in a would close a cycle"},
      {"a 0 b c.d 1; b 0 a c.e 2", "frame 2, b: b in a would close a cycle"}};
  for (const auto& [text, wrong] : invalid)
    EXPECT_EQ(refusal(text), "Invalid: frames: " + std::string(wrong));
  std::string many;
  for (int i = 0; i < 1001; ++i)
    many += "; f" + std::to_string(i) + " 0 root a.b " + std::to_string(i);
  EXPECT_EQ(refusal(many), "TooLarge: frames: 1001 frames are more than 1000");
}

/// The format of lib/graph (G31), which does not use Eigen.
std::string text_of(const Eigen::Isometry3d& joint) {
  std::ostringstream text;
  text.precision(17);
  Eigen::Quaterniond q(joint.linear());
  text << joint.translation().transpose().format(Eigen::IOFormat(17, 0, " ", " ")) << " " << q.x()
       << " " << q.y() << " " << q.z() << " " << q.w();
  return text.str();
}

TEST(GraphFrames, AChainIsTheProductOfItsJoints) {
  RandomMotion random(11);
  Eigen::Isometry3d product = Eigen::Isometry3d::Identity();
  std::string text;
  for (int i = 1; i <= 1000; ++i) {
    Eigen::Isometry3d joint = random.transformation();
    product = product * joint;
    text += (i == 1 ? "" : "; ") + std::string("f") + std::to_string(i) + " 0 " +
            (i == 1 ? "root" : "f" + std::to_string(i - 1)) + " " + text_of(joint);
  }
  auto frames = must(read_frames(text));
  auto T_root_last = must(frames.tree.lookup("root", "f1000", {}));
  EXPECT_LT((T_root_last.matrix() - product.matrix()).norm(), 1e-9) << "1000 roundings of metres";
}

TEST(GraphFrames, NoTextIsABug) {
  std::mt19937 random(12);
  auto whole = [&](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  const std::string pieces[] = {"head",
                                "3",
                                "robot",
                                "0",
                                "1",
                                "-1",
                                ".",
                                "a.b",
                                ";",
                                " ",
                                "; ",
                                "\n",
                                "nan",
                                "1e999",
                                "4",
                                "left_eye",
                                "\xff",
                                "1e-320",
                                std::string(1, '\0')};
  int accepted = 0, refused = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string text = round % 2 == 0 ? kHead : "";
    for (std::size_t i = whole(4); i > 0; --i) {
      std::size_t at = whole(text.size() + 1), length = std::min(whole(6), text.size() - at);
      text.replace(at, length, pieces[whole(std::size(pieces))]);
    }
    auto frames = read_frames(text);
    (frames ? accepted : refused)++;
    if (frames) continue;
    EXPECT_TRUE(frames.error().detail.starts_with("frames: ")) << text;
    EXPECT_EQ(frames.error().detail.find('\n'), std::string::npos) << text;
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace hc::frames
