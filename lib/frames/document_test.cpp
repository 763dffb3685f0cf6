// SPDX-License-Identifier: Apache-2.0
// Runs the example of doc/frames.md, repeated here verbatim.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include <frames/messages.h>
#include <frames/tree.h>

namespace hc {
namespace {

Result<Eigen::Vector3d> example(const Message& report, const Message& image,
                                const Eigen::Vector3d& p_left_eye,
                                const Eigen::Isometry3d& T_world_robot,
                                const Eigen::Isometry3d& T_head_left_eye) {
  // clang-format off: as in the document
  // begin
  hc::frames::Tree tree = hc::frames::Tree::standard();  // the names of the specification
  auto joined = tree.fix("world", "robot", T_world_robot);
  if (joined) joined = tree.join("robot", "head");  // this one moves
  if (joined) joined = tree.fix("head", "left_eye", T_head_left_eye);
  if (!joined) return joined.error();

  // Whenever the head reports where it is:
  auto pose = hc::pose_of(report);
  if (!pose) return pose.error();
  auto fed = tree.feed(pose->to, pose->from, pose->time, pose->T_to_from);
  if (!fed) return fed.error();

  // Whenever there is an image:
  auto T_world_left_eye = tree.lookup("world", "left_eye", image.header.time);
  if (!T_world_left_eye) return T_world_left_eye.error();
  Eigen::Vector3d p_world = *T_world_left_eye * p_left_eye;
  // end
  // clang-format on
  return p_world;
}

/// T_robot_head as the head reports it: raised by 0.3 m, looking ahead.
Message report_at(Time time) {
  Draft draft = Draft::make({MatrixType::Transformation, 1, Scalar::F64, Encoding::Text}, 4, 4);
  as_eigen<double>(draft) = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.3)).matrix();
  draft.header.coord = 2003;
  draft.header.time = time;
  return std::move(draft).finish();
}

Result<Eigen::Vector3d> run_example(Time report_time, Time image_time) {
  Message image;
  image.header.time = image_time;
  Eigen::Isometry3d T_world_robot(Eigen::Translation3d(1, 0, 0));
  Eigen::Isometry3d T_head_left_eye(Eigen::Translation3d(0, 0.1, 0));
  return example(report_at(report_time), image, {0, 0, 2}, T_world_robot, T_head_left_eye);
}

TEST(FramesDocument, TheExampleRuns) {
  auto p_world = run_example(unix_time(100), unix_time(100));
  ASSERT_TRUE(p_world) << p_world.error().text();
  EXPECT_TRUE(p_world->isApprox(Eigen::Vector3d(1, 0.1, 2.3))) << p_world->transpose();
  EXPECT_FALSE(run_example(unix_time(100), unix_time(101)));
}

std::string text_of(const std::string& name) {
  std::ifstream file(HC_SOURCE_DIR "/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  auto from = text.find(begin);
  if (from == std::string::npos) return "no " + begin;
  from += begin.size();
  return text.substr(from, text.find(end, from) - from);
}

TEST(FramesDocument, TheExampleIsTheOneAbove) {
  std::string code = between(text_of("lib/frames/document_test.cpp"), "  // begin\n", "  // end\n");
  std::string unindented;
  std::istringstream lines(code);
  for (std::string line; std::getline(lines, line);)
    unindented += (line.empty() ? line : line.substr(2)) + "\n";
  EXPECT_EQ("hc::frames::Tree tree" +
                between(text_of("doc/frames.md"), "```cpp\nhc::frames::Tree tree", "```"),
            unindented);
}

TEST(FramesDocument, TheErrorItShowsIsTheOneThatComes) {
  frames::Tree tree = frames::Tree::standard();
  ASSERT_TRUE(tree.join("robot", "head"));
  for (int time : {100, 200})
    ASSERT_TRUE(tree.feed("robot", "head", unix_time(time), Eigen::Isometry3d::Identity()));
  std::string told = tree.lookup("robot", "head", unix_time(225)).error().detail;
  std::string shown = between(text_of("doc/frames.md"), "nothing is guessed: `", "`");
  shown.replace(shown.find("\n  "), 3, " ");
  EXPECT_EQ(shown, told);
}

}  // namespace
}  // namespace hc
