// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <sys/stat.h>

#include <hc/testing/must.h>
#include <record/recording_test.h>

#if !defined(__has_feature)
#define __has_feature(feature) 0
#endif
namespace hc::record {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using mcap::kMagic;
using mcap::kRecordHead;
using mcap::Opcode;
using mcap::RecordWriter;
using mcap::StringMap;

class McapReading : public Recordings {};

TEST_F(McapReading, AFileThatIsCutOffIsReadUpToItsLastWholeChunk) {
  const auto all = record_images(in("x.mcap"), 12);
  const std::string whole = bytes_of(in("x.mcap"));
  std::size_t most = 0;
  for (std::size_t size = 0; size < whole.size(); size += size < 2000 ? 1 : 97) {
    write("cut.mcap", whole.substr(0, size));
    const auto played = play(in("cut.mcap"));
    ASSERT_LE(played.messages.size(), all.size());
    ASSERT_GE(played.messages.size(), most);  // never fewer messages than before
    most = played.messages.size();
    for (std::size_t i = 0; i < most; ++i) ASSERT_EQ(played.messages[i], all[i]);
    if (!played.error) continue;  // complete up to DataEnd
    ASSERT_EQ(played.error->code, size < 8 ? Code::Malformed : Code::Truncated) << size;
  }
  EXPECT_EQ(most, all.size());
}

/// The offset of the `number`th record of a kind, from 0.
std::size_t offset_of(Opcode opcode, int number, const std::string& file) {
  std::size_t at = kMagic.size();
  while (static_cast<Opcode>(file.at(at)) != opcode || number-- > 0) {
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + at + 1, sizeof length);
    at += kRecordHead + length;
  }
  return at;
}

/// A file without summary, as left by a recorder that was killed.
std::string without_end(const std::string& file) {
  return file.substr(0, offset_of(Opcode::DataEnd, 0, file));
}

TEST_F(McapReading, FilesThatAreCutOffAreMergedByTimeAndSaidOnce) {
  ManualClock clock;
  for (const char* name : {"a.mcap", "b.mcap"}) {
    auto options = chunks_of(1 << 20);
    options.clock = &clock;
    clock.set_wall(Time(2s));
    auto writer = writer_of(in(name), options);
    const auto stream = *writer->add_stream(name);
    ASSERT_TRUE(writer->add(stream, image(1), Time(1s)));
    ASSERT_TRUE(writer->log({"a", Level::Info, "a line"}));  // not a message of MTP
    ASSERT_TRUE(writer->add(stream, image(2), Time(4s)));
    ASSERT_TRUE(writer->close().status);
    write(name, without_end(bytes_of(in(name))));
  }
  auto writer = writer_of(in("c.mcap"));
  const auto stream = *writer->add_stream("c");
  for (const auto time : {Time(3s), Time(5s)}) ASSERT_TRUE(writer->add(stream, image(3), time));
  ASSERT_TRUE(writer->close().status);
  const auto played = play({in("a.mcap"), in("b.mcap"), in("c.mcap")});
  EXPECT_EQ(played.times,
            (std::vector{Time(1s), Time(1s), Time(3s), Time(4s), Time(4s), Time(5s)}));
  ASSERT_TRUE(played.error);
  EXPECT_EQ(played.error->code, Code::Truncated);
  for (const char* name : {"a.mcap: ", "b.mcap: "})
    EXPECT_NE(played.error->detail.find(in(name)), std::string::npos) << played.error->detail;
}

TEST_F(McapReading, AFileThatIsCutOffEndsOnce) {
  record_images(in("x.mcap"), 3);
  write("cut.mcap", without_end(bytes_of(in("x.mcap"))));
  auto source = must(open_source(in("cut.mcap"), {}));
  Message message;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(*source->take(message), Got::Message);
  EXPECT_EQ(source->take(message).error().code, Code::Truncated);
  ASSERT_TRUE(source->resume());
  EXPECT_EQ(*source->take(message), Got::End);
}

TEST_F(McapReading, DamageIsFoundAndPassedOver) {
  const auto all = record_images(in("x.mcap"), 12);
  const std::string whole = bytes_of(in("x.mcap"));
  // In the messages, and in the length of a chunk.
  for (const std::size_t at : {whole.size() / 2, offset_of(Opcode::Chunk, 1, whole) + 4}) {
    std::string damaged = whole;
    damaged[at] ^= 1;
    auto source = must(open_source(write("damaged.mcap", damaged), {}));
    Message message;
    std::vector<std::string> messages;
    int errors = 0;
    for (auto got = source->take(message); !got || *got != Got::End; got = source->take(message)) {
      if (got) {
        messages.push_back(encode(message));
        continue;
      }
      EXPECT_EQ(got.error().code, Code::Malformed);
      ++errors;
      ASSERT_TRUE(source->resume());
    }
    EXPECT_EQ(errors, 1);
    EXPECT_GE(messages.size(), 8U);
    EXPECT_LT(messages.size(), 12U);
    EXPECT_EQ(messages.back(), all.back());
  }
}

TEST_F(McapReading, HostileFilesCostNoMemory) {
  record_images(in("x.mcap"), 3);
  const std::string whole = bytes_of(in("x.mcap"));
  std::mt19937 random(3);  // NOLINT(cert-msc51-cpp)
  for (int round = 0; round < 3000; ++round) {
    std::string hostile = whole;
    for (int i = 0; i < 3; ++i) {
      const bool near_end = random() % 2 == 0;
      const std::size_t at = near_end ? hostile.size() - 1 - random() % 1500 : random() % 2000;
      hostile[at] = static_cast<char>(random() % 3 == 0 ? 0xff : random());
    }
    write("y.mcap", hostile);
    auto source = open_source(in("y.mcap"), {});
    if (!source) continue;
    Message message;
    for (int errors = 0; errors < 100;) {
      auto got = (*source)->take(message);
      if (got && *got == Got::End) break;
      if (!got && got.error().code == Code::Truncated) break;
      errors += got ? 0 : 1;
    }
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  // ThreadSanitizer adds four times as much.
  constexpr long kMost = (__has_feature(thread_sanitizer) ? 5 : 1) * (700L << 10);  // [KiB]
  EXPECT_LT(usage.ru_maxrss, kMost);
}

/// A file as other programs may write it: without summary; with channels and messages inside
/// unindexed chunks and outside of chunks, not ordered by time.
class ForeignFile {
 public:
  RecordWriter out;

  ForeignFile() {
    out.append(std::as_bytes(std::span(kMagic)));
    out.add(Opcode::Header, "", "others");
  }
  static void add_channel(RecordWriter& to, std::uint16_t id) {
    to.add(Opcode::Channel, id, std::uint16_t{0}, "/topic" + std::to_string(id), "json",
           StringMap());
  }
  static void add_message(RecordWriter& to, std::uint16_t channel, std::uint64_t time) {
    to.begin(Opcode::Message, channel, std::uint32_t{0}, time, time);
    to.append(std::as_bytes(std::span("{}", 2)));
    to.end();
  }
  void add_chunk(const RecordWriter& plain, std::uint64_t first, std::uint64_t last,
                 std::string_view compression) {
    const std::uint64_t size = plain.bytes.size();
    out.begin(Opcode::Chunk, first, last, size, std::uint32_t{0}, compression, size);
    out.append(plain.bytes);
    out.end();
  }
  /// The complete file.
  std::string bytes() {
    out.add(Opcode::DataEnd, std::uint32_t{0});
    out.add(Opcode::Footer, std::uint64_t{0}, std::uint64_t{0}, std::uint32_t{0});
    out.append(std::as_bytes(std::span(kMagic)));
    return {reinterpret_cast<const char*>(out.bytes.data()), out.bytes.size()};
  }
};

TEST_F(McapReading, RecordsThatNoChunkHasAreNotKept) {
  RecordWriter plain;
  for (int i = 0; i < 1000; ++i) {
    plain.add(Opcode::ChunkIndex, std::string(68, '\0'));
    plain.add(Opcode::MetadataIndex, std::string(16, '\0'));
  }
  ForeignFile file;
  file.add_chunk(plain, 0, 0, "");
  write("x.mcap", file.bytes());
  auto reader = must(mcap::Reader::open(in("x.mcap")));
  const auto end = must(reader.next());
  EXPECT_FALSE(end);
  EXPECT_EQ(reader.summary().chunks, 1U);
  EXPECT_TRUE(reader.summary().metadata.empty());
}

TEST_F(McapReading, FilesOfOthersAreReadWholeAndByTime) {
  ForeignFile file;
  RecordWriter first, second;
  file.add_channel(first, 1);
  for (const std::uint64_t time : {7U, 3U, 9U}) file.add_message(first, 1, time);
  file.add_chunk(first, 3, 9, "");
  file.add_channel(file.out, 2);
  for (const std::uint64_t time : {8U, 1U, 5U}) file.add_message(file.out, 2, time);
  for (const std::uint64_t time : {2U, 4U, 6U}) file.add_message(second, 1, time);
  file.add_chunk(second, 2, 6, "");
  write("x.mcap", file.bytes());
  auto reader = mcap::Reader::open(in("x.mcap"));
  EXPECT_TRUE(reader->summary().is_whole);
  EXPECT_EQ(topics_of(reader->summary()),
            (std::map<std::string, std::uint64_t>{{"/topic1", 6}, {"/topic2", 3}}));
  std::vector<std::uint64_t> times;
  for (auto next = reader->next(); next && *next; next = reader->next())
    times.push_back((*next)->record.log_time);
  EXPECT_EQ(times, (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  const auto refused = play(in("x.mcap"));
  EXPECT_EQ(refused.error->code, Code::Unsupported);
  EXPECT_NE(refused.error->detail.find("2 topics, none of them MTP"), std::string::npos);
  // A copy has all topics.
  EXPECT_EQ(topics_of(summary_of(copy({in("x.mcap")}, "y.mcap"))), topics_of(reader->summary()));
}

TEST_F(McapReading, CompanionsWithoutTheirMessagesAreCopied) {
  ForeignFile file;
  file.out.add(Opcode::Channel, std::uint16_t{1}, std::uint16_t{0}, "/a", "json",
               StringMap{{kCompanionKey, "/a/mtp"}});
  RecordWriter first, second;
  for (const std::uint64_t time : {1U, 2U}) file.add_message(first, 1, time);
  file.add_chunk(first, 1, 2, "");
  file.add_message(second, 1, 3);
  file.add_chunk(second, 3, 3, "");
  write("x.mcap", file.bytes());
  EXPECT_EQ(topics_of(summary_of(copy({in("x.mcap")}, "y.mcap"))),
            (std::map<std::string, std::uint64_t>{{"/a", 3}}));
}

TEST_F(McapReading, AMessageAndItsCompanionAreFoundInAnyOrderAndChunks) {
  const auto all = record_images(in("x.mcap"), 2);
  std::vector<mcap::StoredMessage> stored;  // companion, message, companion, message
  auto reader = mcap::Reader::open(in("x.mcap"));
  for (auto next = reader->next(); next && *next; next = reader->next()) stored.push_back(**next);
  ASSERT_EQ(stored.size(), 4U);
  const std::vector<std::vector<std::size_t>> orders[] = {
      {{1, 0, 3, 2}}, {{0}, {1, 2}, {3}}, {{1}, {0, 3}, {2}}, {{1, 3}, {0, 2}}};
  for (const auto& chunks : orders) {
    ForeignFile file;
    for (const auto& [id, schema] : reader->summary().schemas)
      file.out.add(Opcode::Schema, id, schema.name, schema.encoding, schema.text);
    for (const auto& [id, channel] : reader->summary().channels)
      file.out.add(Opcode::Channel, id, channel.schema, channel.topic, channel.encoding,
                   channel.metadata);
    for (const auto& chunk : chunks) {
      RecordWriter plain;
      std::set<std::uint64_t> times;
      for (const auto i : chunk) {
        const auto& [channel, sequence, log_time, publish_time] = stored[i].record;
        plain.begin(Opcode::Message, channel, sequence, log_time, publish_time);
        plain.append(stored[i].data);
        plain.end();
        times.insert(log_time);
      }
      file.add_chunk(plain, *times.begin(), *times.rbegin(), "");
    }
    const auto sorted = write("sorted.mcap", file.bytes());
    EXPECT_EQ(play(sorted).messages, all);
    fs::remove(in("again.mcap"));
    EXPECT_EQ(play(copy({sorted}, "again.mcap")).messages, all);
  }
}

TEST_F(McapReading, TopicsOfOneNameAndTwoDefinitionsStayTwo) {
  const auto write_topic = [&](const std::string& name, const std::string& text) {
    ForeignFile file;
    file.out.add(Opcode::Schema, std::uint16_t{1}, "robot/msg/Status", "ros2msg", text);
    file.out.add(Opcode::Channel, std::uint16_t{1}, std::uint16_t{1}, "/status", "cdr",
                 StringMap());
    file.add_message(file.out, 1, 1);
    return write(name, file.bytes());
  };
  const auto one = write_topic("a.mcap", "int32 volts"), two = write_topic("b.mcap", "int64 volts"),
             same = write_topic("c.mcap", "int32 volts");
  const auto summary = summary_of(copy({one, two, same}, "all.mcap"));
  EXPECT_EQ(topics_of(summary),
            (std::map<std::string, std::uint64_t>{{"/status", 2}, {"/status_2", 1}}));
  for (const auto& [id, channel] : summary.channels)
    EXPECT_EQ(summary.schemas.at(channel.schema).text,
              channel.topic == "/status" ? "int32 volts" : "int64 volts");
}

TEST_F(McapReading, WhatCannotBeReadIsSaid) {
  ForeignFile file;
  file.add_channel(file.out, 1);
  file.add_message(file.out, 1, 5);
  RecordWriter chunk;
  file.add_message(chunk, 1, 6);
  file.add_chunk(chunk, 6, 6, "lz4");
  write("x.mcap", file.bytes());
  const auto summary = summary_of(in("x.mcap"));
  EXPECT_EQ(summary.counts.at(1), 1U);
  EXPECT_EQ(summary.unread, 1U);
  EXPECT_NE(summary.why_unread.find("lz4"), std::string::npos);
}

TEST_F(McapReading, ALongRecordingOfTinyChunksIsRead) {
  constexpr int kCount = 500;
  record_images(in("x.mcap"), kCount, chunks_of(1), 1);
  mcap::ReaderLimits limits;
  limits.summary_bytes = 10000;  // far less than the index of the chunks
  EXPECT_EQ(summary_of(in("x.mcap"), limits).chunks, kCount);
  const std::string whole = bytes_of(in("x.mcap"));
  write("cut.mcap", whole.substr(0, whole.size() / 2));
  const auto summary = summary_of(in("cut.mcap"), limits);
  EXPECT_FALSE(summary.is_whole);
  EXPECT_GT(summary.chunks, 100U);
}

TEST_F(McapReading, AChunkWhoseIndexIsCutOffIsReadForAStream) {
  auto writer = writer_of(in("x.mcap"), chunks_of(1 << 20));
  const auto left = *writer->add_stream("eye.left"), right = *writer->add_stream("eye.right");
  ASSERT_TRUE(writer->add(left, image(1), unix_time(1)));
  ASSERT_TRUE(writer->add(right, image(2), unix_time(2)));
  ASSERT_TRUE(writer->close().status);
  // After the indexes of the left eye's two channels.
  const std::string whole = bytes_of(in("x.mcap"));
  write("cut.mcap", whole.substr(0, offset_of(Opcode::MessageIndex, 2, whole)));
  const auto played = play(in("cut.mcap?stream=eye.right"));
  EXPECT_EQ(played.messages, std::vector{encode(image(2))});
}

TEST_F(McapReading, APipeIsRefusedAtOnce) {
  ASSERT_EQ(::mkfifo((in("x.mcap")).c_str(), 0600), 0);
  EXPECT_EQ(play(in("x.mcap")).error->code, Code::Unsupported);
}

TEST_F(McapReading, AllMetadataIsFound) {
  auto writer = writer_of(in("x.mcap"), chunks_of());
  ASSERT_TRUE(writer->metadata("a", {{"x", "1"}}));
  ASSERT_TRUE(writer->add(*writer->add_stream("eye"), image(1), unix_time(1)));
  ASSERT_TRUE(writer->metadata("b", {{"x", "2"}}));
  ASSERT_TRUE(writer->metadata("a", {{"x", "3"}}));
  ASSERT_TRUE(writer->close().status);
  const auto all = *mcap::Reader::open(in("x.mcap"))->metadata();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].words, (StringMap{{"x", "1"}}));
  EXPECT_EQ(all[1].name, "b");
  EXPECT_EQ(all[2].words, (StringMap{{"x", "3"}}));
}

TEST_F(McapReading, Crc32IsThatOfZlib) {
  const std::string_view text = "123456789";
  EXPECT_EQ(mcap::crc32(std::as_bytes(std::span(text))), 0xcbf43926U);
  EXPECT_EQ(mcap::crc32(std::as_bytes(std::span(text).subspan(3)),
                        mcap::crc32(std::as_bytes(std::span(text).first(3)))),
            0xcbf43926U);
}

TEST_F(McapReading, OtherFilesAreRefused) {
  write("x.mcap", "1 7 0 0 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n");
  EXPECT_EQ(play(in("x.mcap")).error->code, Code::Malformed);
  EXPECT_EQ(play(in("none.mcap")).error->code, Code::NotFound);
  EXPECT_EQ(play(in("x.mcap?keep=all")).error->code, Code::Invalid);
}

}  // namespace
}  // namespace hc::record
