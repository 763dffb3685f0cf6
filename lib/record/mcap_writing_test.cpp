// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <gtest/gtest.h>

#include <record/recording_test.h>

namespace hc::record {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
class McapWriting : public Recordings {};

TEST_F(McapWriting, EveryMessageComesOutAsItWentIn) {
  auto writer = writer_of(in("x.mcap"), chunks_of());
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp)
  std::vector<std::string> all;
  for (int type = 1; type <= 12; ++type)
    for (int scalar = 0; scalar < 10; ++scalar)
      for (int encoding = 0; encoding < 4; ++encoding)
        for (int components : {1, 2, 3, 6}) {
          const Info info{static_cast<MatrixType>(type), static_cast<std::uint8_t>(components),
                          static_cast<Scalar>(scalar), static_cast<Encoding>(encoding)};
          if (broken_rule(info) != 0) continue;
          const auto stream = *writer->add_stream("m.p" + std::to_string(info.code()));
          for (const auto& [width, height] : {std::pair(1, 1), {4, 4}, {1, 0}, {1, 3}, {5, 1}}) {
            Header header;
            header.info = info;
            header.width = width;
            header.height = height;
            if (!check(header)) continue;
            auto message = message_of(info, width, height, static_cast<int>(random() % 9), random);
            message.header.coord = static_cast<std::int32_t>(random() % 15);
            ASSERT_TRUE(writer->add(stream, message, unix_time(1)));
            all.push_back(encode(message));
          }
        }
  ASSERT_TRUE(writer->close().status);
  const auto played = play(in("x.mcap"));
  EXPECT_FALSE(played.error) << played.error->text();
  ASSERT_GT(all.size(), 900U);
  EXPECT_EQ(played.messages, all);
}

TEST_F(McapWriting, NoImageIsStoredTwice) {
  const auto all = record_images(in("x.mcap"), 20);  // random pixels do not compress
  EXPECT_LT(static_cast<double>(fs::file_size(in("x.mcap"))),
            1.1 * static_cast<double>(20 * all[0].size()) + 5000);
}

TEST_F(McapWriting, ALargeBlankImageIsReadAgain) {
  auto writer = writer_of(in("x.mcap"));
  auto draft = Draft::make({MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}, 4000, 6000);
  std::ranges::fill(draft.elements(), std::byte(0));
  const auto blank = std::move(draft).finish();
  ASSERT_TRUE(writer->add(*writer->add_stream("eye"), blank, unix_time(1)));
  ASSERT_TRUE(writer->close().status);
  EXPECT_LT(fs::file_size(in("x.mcap")), 100'000U);
  EXPECT_EQ(play(in("x.mcap")).messages.size(), 1U);
}

TEST_F(McapWriting, AStreamIsReadAlone) {
  auto writer = writer_of(in("x.mcap"), chunks_of());
  const auto left = *writer->add_stream("eye.left"), right = *writer->add_stream("eye.right");
  std::vector<std::string> all;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(writer->add(left, image(i), unix_time(i + 1)));
    if (i < 10) continue;
    ASSERT_TRUE(writer->add(right, image(100 + i), unix_time(i + 1)));
    all.push_back(encode(image(100 + i)));
  }
  ASSERT_TRUE(writer->close().status);
  EXPECT_EQ(play(in("x.mcap?stream=eye.right")).messages, all);
  EXPECT_EQ(play(in("x.mcap")).messages.size(), 30U);
  const auto wrong = play(in("x.mcap?stream=eye.rght"));
  ASSERT_TRUE(wrong.error);
  EXPECT_EQ(wrong.error->code, Code::NotFound);
  EXPECT_NE(wrong.error->detail.find("did you mean \"eye.right\"?"), std::string::npos);
}

TEST_F(McapWriting, TheSummarySaysWhatIsThere) {
  record_images(in("x.mcap"), 20);
  const auto summary = summary_of(in("x.mcap"));
  EXPECT_TRUE(summary.is_whole);
  EXPECT_EQ(topics_of(summary),
            (std::map<std::string, std::uint64_t>{{"/eye/left", 20}, {"/eye/left/mtp", 20}}));
  EXPECT_EQ(summary.end - summary.begin, 19U);
  const auto found = streams_of(summary);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "eye.left");
  EXPECT_EQ(found[0].channels.size(), 2U);
  EXPECT_EQ(found[0].type, "sensor_msgs/msg/Image");
  EXPECT_EQ(found[0].messages, 20U);
}

TEST_F(McapWriting, AMessageIsInTheChunkOfItsCompanion) {
  const auto all = record_images(in("x.mcap"), 20, chunks_of(1 << 20));
  auto writer = writer_of(in("y.mcap"), chunks_of(1));
  auto reader = *Reader::open({must(place_of(in("x.mcap")))}, {}, writer->copied_topics());
  const auto live = *writer->add_stream("live");
  for (auto copied = Result<bool>(true); copied && *copied;) {
    copied = writer->copy(*reader);
    ASSERT_TRUE(writer->add(live, image(0, 1), unix_time(1)));  // ends a chunk
  }
  ASSERT_TRUE(writer->close().status);
  EXPECT_EQ(play(in("y.mcap?stream=eye.left")).messages, all);
  auto stored = mcap::Reader::open(in("y.mcap"));
  std::map<std::string, std::shared_ptr<const void>> chunks;  // of each topic's last message
  int pairs = 0;
  for (auto next = stored->next(); next && *next; next = stored->next()) {
    const auto& topic = (*next)->channel->topic;
    chunks[topic] = (*next)->owner;
    if (topic != "/eye/left/mtp") continue;
    EXPECT_EQ(chunks["/eye/left"], chunks[topic]) << ++pairs;
    ++pairs;
  }
  EXPECT_EQ(pairs, 20);
}

TEST_F(McapWriting, ACopyHasAllThatAFileOfOthersHas) {
  {
    auto file = *mcap::File::create(in("x.mcap"), "ros1");
    ASSERT_TRUE(file.add(mcap::SchemaRecord{1, "Chatter", "ros1msg", "string data"}));
    // Two publishers of a topic, and one that sends nothing.
    for (std::uint16_t id = 1; id <= 3; ++id)
      ASSERT_TRUE(file.add(mcap::ChannelRecord{
          id, 1, id == 3 ? "/idle" : "/chat", "ros1", {{"callerid", std::to_string(id)}}}));
    for (const char* word : {"1", "2"})
      ASSERT_TRUE(file.add(mcap::MetadataRecord{"a", {{"x", word}}}));
    mcap::ChunkBuilder chunk;
    const std::array data{std::byte(7)};
    const std::span<const std::byte> pieces[] = {data};
    for (std::uint16_t id = 1; id <= 2; ++id) chunk.add({id, 0, id, id}, pieces);
    ASSERT_TRUE(file.add(chunk.pack()));
    ASSERT_TRUE(file.close());
  }
  WriterOptions options;
  options.profile = "ros1";
  ASSERT_EQ(copied({in("x.mcap")}, "y.mcap", options).status.has_value(), true);
  auto copy = *mcap::Reader::open(in("y.mcap"));
  const auto& summary = copy.summary();
  EXPECT_EQ(summary.profile, "ros1");
  EXPECT_EQ(summary.metadata, (std::vector<std::string>{"a", "a"}));
  std::map<std::string, std::pair<std::string, std::uint64_t>> channels;
  for (const auto& [id, channel] : summary.channels)
    channels[channel.metadata.at("callerid")] = {
        channel.topic, summary.counts.contains(id) ? summary.counts.at(id) : 0};
  EXPECT_EQ(channels,
            (decltype(channels){{"1", {"/chat", 1}}, {"2", {"/chat", 1}}, {"3", {"/idle", 0}}}));
  // The channels of two files are merged.
  ASSERT_TRUE(copied({in("x.mcap"), in("y.mcap")}, "z.mcap").status);
  EXPECT_EQ(summary_of(in("z.mcap")).channels.size(), 3U);
}

TEST_F(McapWriting, StreamsThatHaveNoRoomInAFileAreDropped) {
  std::vector<std::string> said;
  auto options = chunks_of(1 << 20);
  options.log = [&](Level, std::string_view line) { said.emplace_back(line); };
  auto writer = writer_of(in("x.mcap"), options);
  const auto message = image(0, 1);
  std::size_t recorded = 0;
  for (; recorded < 40000; ++recorded) {
    ASSERT_TRUE(
        writer->add(*writer->add_stream("s" + std::to_string(recorded)), message, unix_time(1)));
    if (!said.empty()) break;
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(
      said[0].starts_with("s" + std::to_string(recorded) + " dropped: MCAP: a file can have"));
  EXPECT_TRUE(writer->add(0, message, unix_time(2)));
  ASSERT_TRUE(writer->close().status);
  EXPECT_EQ(writer->written().lost, 1U);
  EXPECT_EQ(writer->written().messages, recorded + 1);
  const auto played = play(in("x.mcap"));
  EXPECT_FALSE(played.error) << played.error->text();
  EXPECT_EQ(played.messages.size(), recorded + 1);
  EXPECT_EQ(play(in("x.mcap?stream=s0")).messages.size(), 2U);
  EXPECT_EQ(streams_of(summary_of(in("x.mcap"))).size(), recorded);
}

TEST_F(McapWriting, AFullDiskEndsTheRecordingWithAValidFile) {
  const FullDisk full(300'000);
  auto writer = writer_of(in("x.mcap"), chunks_of());
  const auto stream = *writer->add_stream("eye.left");
  Status status;
  std::vector<std::string> all;
  for (int i = 0; i < 100000 && status; ++i) {
    status = writer->add(stream, image(i), unix_time(i + 1));
    all.push_back(encode(image(i)));
  }
  const auto& closed = writer->close();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().detail.find("File too large"), std::string::npos);
  EXPECT_EQ(closed.status.error().detail, status.error().detail);
  const auto played = play(in("x.mcap"));
  EXPECT_FALSE(played.error) << played.error->text();
  ASSERT_GT(played.messages.size(), 70U);
  EXPECT_EQ(played.messages.size(), closed.messages);
  EXPECT_EQ(closed.messages + closed.lost, all.size());
  for (std::size_t i = 0; i < played.messages.size(); ++i) ASSERT_EQ(played.messages[i], all[i]);
  EXPECT_TRUE(summary_of(in("x.mcap")).is_whole);
}

TEST_F(McapWriting, ARecordingIsSplitAndItsOldestFilesAreRemoved) {
  auto options = chunks_of();
  options.split = 50000;
  options.keep = 200000;
  options.frames = "head 3 robot 1 2 3 0 0 0 1";
  const auto all = record_images(in("x.mcap"), 200, options);
  EXPECT_FALSE(fs::exists(in("x_0001.mcap")));
  std::vector<std::string> files;
  std::uintmax_t size = 0;
  for (const auto& file : fs::directory_iterator(in(""))) {
    files.push_back(file.path());
    size += file.file_size();
  }
  EXPECT_LE(size, options.keep + 20000);
  ASSERT_GE(files.size(), 3U);
  std::ranges::sort(files);
  std::vector<std::string> messages;
  for (const auto& file : files) {
    const auto played = play(file);
    EXPECT_FALSE(played.error);
    messages.insert(messages.end(), played.messages.begin(), played.messages.end());
    const auto summary = summary_of(file);
    EXPECT_EQ(topics_of(summary)["/tf_static"], 1U) << file;
    EXPECT_LT(summary.end - summary.begin, 60U) << file;  // repeated with the file's start time
  }
  EXPECT_TRUE(std::equal(messages.rbegin(), messages.rend(), all.rbegin()));
}

TEST_F(McapWriting, NumberedFilesOfBeforeStay) {
  write("x_0007.mcap", "kept");
  write("x_copy.mcap", "kept");
  auto options = chunks_of();
  options.last = std::chrono::seconds(10);
  for (int run = 0; run < 2; ++run) {
    auto writer = writer_of(in("x.mcap"), options);
    const auto stream = *writer->add_stream("eye.left");
    ASSERT_TRUE(writer->add(stream, image(run), unix_time(1)));
    writer->save();
    EXPECT_EQ(writer->close().files, std::vector{in("x_000" + std::to_string(8 + run) + ".mcap")});
  }
  EXPECT_EQ(bytes_of(in("x_0007.mcap")), "kept");
  EXPECT_EQ(play(in("x_0008.mcap")).messages, std::vector{encode(image(0))});
  options.last = {};
  options.split = 50000;
  ASSERT_TRUE(writer_of(in("x.mcap"), options)->close().status);
  EXPECT_TRUE(fs::exists(in("x_0010.mcap")));
}

TEST_F(McapWriting, WhatWasLastIsSaved) {
  std::vector<std::string> said;
  auto options = chunks_of();
  options.last = std::chrono::seconds(10);
  options.frames = "head 3 robot 1 2 3 0 0 0 1";
  options.log = [&](Level, std::string_view line) { said.emplace_back(line); };
  auto writer = writer_of(in("x.mcap"), options);
  const auto stream = *writer->add_stream("eye.left");
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(writer->add(stream, image(i), Time((i + 1) * 1s)));
  writer->save();
  EXPECT_EQ(said, std::vector{"saved " + in("x_0001.mcap")});
  for (int i = 60; i < 70; ++i) ASSERT_TRUE(writer->add(stream, image(i), Time((i + 1) * 1s)));
  writer->save();
  const auto written = writer->close();
  ASSERT_TRUE(written.status);
  auto played = play(in("x_0001.mcap"));
  EXPECT_FALSE(played.error);
  EXPECT_GE(played.messages.size(), 10U);
  EXPECT_LE(played.messages.size(), 15U);  // whole chunks
  EXPECT_EQ(played.messages.back(), encode(image(59)));
  const auto summary = summary_of(in("x_0001.mcap"));
  EXPECT_LE(summary.end - summary.begin, 15'000'000'000U);  // lasting messages get the start time
  EXPECT_EQ(topics_of(summary)["/tf_static"], 1U);
  const auto second = play(in("x_0002.mcap")).messages;
  EXPECT_EQ(second.back(), encode(image(69)));
  // Those that both files have count once.
  std::set<std::string> all(second.begin(), second.end());
  all.insert(played.messages.begin(), played.messages.end());
  EXPECT_LT(all.size(), played.messages.size() + second.size());
  EXPECT_EQ(written.messages, all.size());
  EXPECT_EQ(written.messages + written.discarded, 70U);
}

TEST_F(McapWriting, NothingIsSavedAfterTheEnd) {
  std::vector<std::string> said;
  auto options = chunks_of();
  options.last = std::chrono::seconds(10);
  options.log = [&](Level, std::string_view line) { said.emplace_back(line); };
  auto writer = writer_of(in("x.mcap"), options);
  ASSERT_TRUE(writer->close().status);
  writer->save();
  EXPECT_EQ(said, std::vector<std::string>{"not saved: the recording has ended"});
}

}  // namespace
}  // namespace hc::record
