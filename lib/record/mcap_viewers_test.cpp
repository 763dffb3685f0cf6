// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/matrix_view.h>
#include <hc/testing/must.h>
#include <record/recording_test.h>
#include <ros/cdr.h>
#include <ros/messages.h>
namespace hc::record {
namespace {

using mcap::Opcode;
using mcap::StringMap;

class McapForViewers : public Recordings {};

TEST_F(McapForViewers, StreamsNeverShareATopic) {
  auto writer = writer_of(in("x.mcap"), chunks_of());
  std::vector<std::string> all;
  int number = 0;
  for (const char* name : {"a", "a.mtp", "a.mtp.mtp", "a", "b.mtp", "b", "tf", "b.compressed"}) {
    const auto stream = *writer->add_stream(name);
    ASSERT_TRUE(writer->add(stream, image(++number), unix_time(1)));
    all.push_back(encode(image(number)));
  }
  ASSERT_TRUE(writer->close().status);
  EXPECT_EQ(play(in("x.mcap")).messages, all);
  EXPECT_EQ(play(in("x.mcap?stream=a.mtp")).messages, std::vector{all[1]});
  EXPECT_EQ(play(in("x.mcap?stream=b")).messages, std::vector{all[5]});
  const auto summary = summary_of(in("x.mcap"));
  EXPECT_EQ(topics_of(summary).size(), summary.channels.size());
}

TEST_F(McapForViewers, TracesHaveNoTopicForViewers) {
  auto writer = writer_of(in("x.mcap"), chunks_of());
  std::vector<std::string> all;
  for (const char* name : {"eye.trace", "eye.left"}) {
    ASSERT_TRUE(writer->add(*writer->add_stream(name), image(1), unix_time(1)));
    all.push_back(encode(image(1)));
  }
  ASSERT_TRUE(writer->close().status);
  EXPECT_EQ(play(in("x.mcap")).messages, all);
  EXPECT_EQ(topics_of(summary_of(in("x.mcap"))),
            (std::map<std::string, std::uint64_t>{
                {"/eye/left", 1}, {"/eye/left/mtp", 1}, {"/eye/trace/mtp", 1}}));
}

TEST_F(McapForViewers, OfEachStaticFrameTheLatestIsRepeated) {
  auto options = chunks_of();
  std::vector<std::string> files;
  for (const char* cup : {"1 2 3", "4 5 6", "7 8 9"}) {
    options.frames = "head 3 robot 1 2 3 0 0 0 1; cup 200 head " + std::string(cup) + " 0 0 0 1";
    files.push_back(in(std::string(1, cup[0]) + ".mcap"));
    record_images(files.back(), cup[0] == '7' ? 20 : 1, options);
  }
  options = chunks_of();
  options.split = 20000;
  const auto written = copied(files, "all.mcap", options);
  ASSERT_GT(written.files.size(), 1U);
  EXPECT_EQ(topics_of(summary_of(written.files.front()))["/tf_static"], 3U);
  EXPECT_EQ(topics_of(summary_of(written.files.back()))["/tf_static"], 1U);
}

TEST_F(McapForViewers, StaticFramesThatCannotBeReadAreAllRepeated) {
  ForeignFile file;
  std::uint16_t channel = 0;
  for (const std::string robot : {"a", "b"}) {
    file.out.add(Opcode::Channel, ++channel, std::uint16_t{0}, "/tf_static", "json",
                 StringMap{{"robot", robot}});
    file.add_message(file.out, channel, 1);
  }
  write("tf.mcap", file.bytes());
  record_images(in("x.mcap"), 20);
  auto options = chunks_of();
  options.split = 20000;
  const auto written = copied({in("tf.mcap"), in("x.mcap")}, "all.mcap", options);
  ASSERT_GT(written.files.size(), 1U);
  EXPECT_EQ(topics_of(summary_of(written.files.back()))["/tf_static"], 2U);
}

TEST_F(McapForViewers, OfStaticFramesWithoutEndTheLatestAreRepeatedAndThoseThatCanBeRead) {
  auto options = chunks_of();
  options.frames = "head 3 robot 1 2 3 0 0 0 1";
  record_images(in("fixed.mcap"), 1, options);
  constexpr std::uint64_t kCount = 300, kSize = mcap::Storage::kMostLasting / 100;
  const std::vector<std::byte> unknown(kSize, std::byte('x'));
  ForeignFile file;
  file.out.add(Opcode::Channel, std::uint16_t{1}, std::uint16_t{0}, "/tf_static", "json",
               StringMap());
  for (std::uint64_t time = 2; time < 2 + kCount; ++time) {
    file.out.begin(Opcode::Message, std::uint16_t{1}, std::uint32_t{0}, time, time);
    file.out.append(unknown);
    file.out.end();
  }
  write("tf.mcap", file.bytes());
  auto writer = writer_of(in("x.mcap"), chunks_of());  // numbered after both
  const auto stream = *writer->add_stream("eye.left");
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(writer->add(stream, image(i), unix_time(1000 + i)));
  ASSERT_TRUE(writer->close().status);
  options = chunks_of();
  options.split = 20000;
  const auto written = copied({in("fixed.mcap"), in("tf.mcap"), in("x.mcap")}, "all.mcap", options);
  ASSERT_GT(written.files.size(), 1U);
  std::map<std::string, std::uint64_t> counts;  // by encoding
  const auto summary = summary_of(written.files.back());
  for (const auto& [id, channel] : summary.channels)
    if (channel.topic == "/tf_static" && summary.counts.contains(id))
      counts[channel.encoding] = summary.counts.at(id);
  EXPECT_EQ(counts["cdr"], 1U);
  EXPECT_GT(counts["json"], 90U);
  EXPECT_LT(counts["json"], 100U);
}

/// A `transformation` along x, from a neck of address 11.
Message pose(std::int32_t coord, double x) {
  auto draft = Draft::make({MatrixType::Transformation, 1, Scalar::F64, Encoding::Binary}, 4, 4);
  draft.header.src = 11;
  draft.header.coord = coord;
  draft.header.time = unix_time(1'763'683'200'000'000'000 + coord);
  const std::array<double, 16> T = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::ranges::copy(T, view<double>(draft).numbers().begin());
  return std::move(draft).finish();
}

TEST_F(McapForViewers, EachJointThatAnOutputMovesIsOnTf) {
  auto options = chunks_of();
  options.frames =
      "head 3 robot neck.pose 11; left_eye 4 head neck.pose 11; cup 200 head 1 2 3 0 0 0 1";
  auto writer = writer_of(in("x.mcap"), options);
  const auto stream = *writer->add_stream("neck.pose");
  const auto other = *writer->add_stream("arm.pose");
  ASSERT_TRUE(writer->add(stream, pose(2003, 0.5), unix_time(1)));
  ASSERT_TRUE(writer->add(stream, pose(3004, 0.25), unix_time(2)));
  ASSERT_TRUE(writer->add(stream, pose(7, 9), unix_time(3)));    // not a joint's coord
  ASSERT_TRUE(writer->add(other, pose(2003, 9), unix_time(4)));  // of a stream without joints
  ASSERT_TRUE(writer->close().status);
  auto reader = must(mcap::Reader::open(in("x.mcap")));
  std::vector<std::string> joints;
  for (auto message = reader.next(); message && *message; message = reader.next()) {
    if ((*message)->channel->topic != "/tf") continue;
    const auto tf = must(ros::CdrReader::read<ros::TfMessage>((*message)->data));
    for (const auto& each : tf.transforms)
      joints.push_back(each.header.frame_id + " " + each.child_frame_id + " " +
                       std::to_string(each.transform.position.x) + " " +
                       std::to_string(each.header.stamp.nanosec));
  }
  EXPECT_EQ(joints,
            (std::vector<std::string>{"robot head 0.500000 2003", "head left_eye 0.250000 3004"}));
}

}  // namespace
}  // namespace hc::record
