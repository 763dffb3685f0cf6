// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <gtest/gtest.h>

#include <ros/cdr_test.h>
#include <ros/messages.h>
#include <ros/schema.h>

namespace hc::ros {
namespace {

TEST(Cdr, AlignsNumbersBehindTheEncapsulation) {
  MultiArrayDimension dimension{"ab", 1, 2};
  EXPECT_EQ(cdr(dimension),
            octets({0, 1, 0, 0, 3, 0, 0, 0, 'a', 'b', 0, 0, 1, 0, 0, 0, 2, 0, 0, 0}));
  JointState joints;
  joints.name = {"x"};
  joints.position = {1};
  EXPECT_EQ(cdr(joints),
            octets({0, 1, 0, 0, 0, 0, 0, 0, 0,   0, 0,    0,    1, 0, 0, 0, 0, 0, 0, 0,  // header
                    1, 0, 0, 0, 2, 0, 0, 0, 'x', 0, 0,    0,                             // names
                    1, 0, 0, 0, 0, 0, 0, 0, 0,   0, 0xf0, 0x3f,  // at 28: 1, at 32: 1.0
                    0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Cdr, LargeMembersStayWhereTheyAre) {
  const auto pixels = octets({1, 2, 3});
  CdrWriter writer;
  const auto pieces = writer.write(Image{{}, 1, 1, "rgb8", 0, 3, {pixels}});
  EXPECT_EQ(pieces.body.data(), pixels.data());
  EXPECT_EQ(pieces.body.size(), 3U);
  EXPECT_TRUE(pieces.tail.empty());
  const auto all = bytes_of(pieces);
  auto image = must(CdrReader::read<Image>(all));
  EXPECT_EQ(image.encoding, "rgb8");
  EXPECT_EQ(image.data.bytes.data(), all.data() + pieces.head.size());
}

TEST(Cdr, ReadsWhatItWrote) {
  Log log;
  log.stamp = {-1, 999'999'999};
  log.msg = "one\ntwo";
  log.line = 7;
  auto read = must(CdrReader::read<Log>(cdr(log)));
  EXPECT_EQ(read.stamp.sec, -1);
  EXPECT_EQ(read.msg, log.msg);
  EXPECT_EQ(read.line, 7U);
  TfMessage tf;
  tf.transforms.resize(2);
  tf.transforms[1].child_frame_id = "head";
  tf.transforms[1].transform.position.z = 0.5;
  const auto again = must(CdrReader::read<TfMessage>(cdr(tf)));
  ASSERT_EQ(again.transforms.size(), 2U);
  EXPECT_EQ(again.transforms[1].transform.position.z, 0.5);
}

TEST(Cdr, AMessageThatIsCutShortIsRefused) {
  JointState joints;
  joints.name = {"roll", "tilt"};
  joints.position = {1, 2};
  const auto whole = cdr(joints);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(refused(CdrReader::read<JointState>(std::span(whole).first(size))).code,
              Code::Malformed);
  }
}

TEST(Cdr, PromisesThatAreNotKeptCostNoMemory) {
  auto all = cdr(JointState{});
  for (std::size_t at = 4; at + 4 <= all.size(); ++at) {
    auto hostile = all;
    for (std::size_t i = 0; i < 4; ++i) hostile[at + i] = std::byte{0xff};
    const auto read = CdrReader::read<JointState>(hostile);
    if (read) {
      EXPECT_LE(read->position.capacity(), 4U);
    }
  }
}

TEST(Cdr, AnotherEncodingIsUnsupported) {
  auto all = cdr(Twist{});
  all[1] = std::byte{0};
  EXPECT_EQ(refused(CdrReader::read<Twist>(all)).code, Code::Unsupported);
}

TEST(Cdr, RandomBytesAreReadOrRefused) {
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp)
  for (int round = 0; round < 20000; ++round) {
    std::vector<std::byte> all(random() % 200);
    for (auto& each : all) each = static_cast<std::byte>(random() % 4);
    if (all.size() > 2) all[0] = std::byte{0}, all[1] = std::byte{1};
    static_cast<void>(CdrReader::read<PointCloud2>(all));
    static_cast<void>(CdrReader::read<TfMessage>(all));
  }
}

TEST(Schema, HasTheDefinitionsThatItIsMadeOf) {
  EXPECT_EQ(schema(Type::PoseStamped).name, "geometry_msgs/msg/PoseStamped");
  const auto& text = schema(Type::TfMessage).text;
  for (const char* part : {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Vector3",
                           "geometry_msgs/Transform", "geometry_msgs/TransformStamped"}) {
    const std::string head = std::string(80, '=') + "\nMSG: " + part + "\n";
    const auto at = text.find(head);
    ASSERT_NE(at, std::string::npos) << part;
    EXPECT_EQ(text.find(head, at + 1), std::string::npos) << part;
  }
  EXPECT_EQ(type_of("sensor_msgs/msg/Image"), Type::Image);
  EXPECT_FALSE(type_of("sensor_msgs/Image"));
  for (const auto& each : schemas()) EXPECT_EQ(type_of(each.name), each.type);
}

}  // namespace
}  // namespace hc::ros
