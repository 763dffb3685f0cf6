// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <sys/stat.h>

#include <random>
#include <set>

#include <hc/mtp/matrix_view.h>
#include <hc/testing/must.h>
#include <record/recording_test.h>
#include <ros/cdr.h>
#include <ros/messages.h>

#if !defined(__has_feature)
#define __has_feature(feature) 0
#endif

namespace hc::record {
namespace {

using mcap::kMagic;
using mcap::kRecordHead;
using mcap::Opcode;
using mcap::RecordWriter;
using mcap::StringMap;

namespace fs = std::filesystem;
using namespace std::chrono_literals;

Message message_of(const Info& info, std::int32_t width, std::int32_t height, std::int64_t seq,
                   std::mt19937& random) {
  auto draft = Draft::make(info, height, width);
  draft.header.seq = seq;
  draft.header.src = 7;
  draft.header.time = unix_time(1'763'683'200'000'000'000 + seq);
  for (auto& each : draft.elements()) each = static_cast<std::byte>(random());
  if (info.encoding == Encoding::Text)  // no NaN, whose bits text does not preserve
    for (auto& each : draft.elements()) each = static_cast<std::byte>(random() % 64);
  return std::move(draft).finish();
}

Message image(std::int64_t seq, std::int32_t width = 40) {
  std::mt19937 random(static_cast<unsigned>(seq));
  return message_of({MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}, width, 30, seq,
                    random);
}

WriterOptions chunks_of(std::size_t bytes = 10000) {
  WriterOptions options;
  options.chunk_bytes = bytes;
  return options;
}

class Mcap : public Recordings {};

/// Records images 0 … count - 1 at 1 ns, 2 ns, …; returns the bytes of each.
std::vector<std::string> record_images(const std::string& file, int count,
                                       const WriterOptions& options = chunks_of(),
                                       std::int32_t width = 40) {
  auto writer = writer_of(file, options);
  const auto stream = *writer->add_stream("eye.left");
  std::vector<std::string> all;
  for (int i = 0; i < count; ++i) {
    const auto message = image(i, width);
    EXPECT_TRUE(writer->add(stream, message, unix_time(i + 1)));
    all.push_back(encode(message));
  }
  EXPECT_TRUE(writer->close().status);
  return all;
}

TEST_F(Mcap, EveryMessageComesOutAsItWentIn) {
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

TEST_F(Mcap, NoImageIsStoredTwice) {
  const auto all = record_images(in("x.mcap"), 20);  // random pixels do not compress
  EXPECT_LT(static_cast<double>(fs::file_size(in("x.mcap"))),
            1.1 * static_cast<double>(20 * all[0].size()) + 5000);
}

TEST_F(Mcap, ALargeBlankImageIsReadAgain) {
  auto writer = writer_of(in("x.mcap"));
  auto draft = Draft::make({MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}, 4000, 6000);
  std::ranges::fill(draft.elements(), std::byte(0));
  const auto blank = std::move(draft).finish();
  ASSERT_TRUE(writer->add(*writer->add_stream("eye"), blank, unix_time(1)));
  ASSERT_TRUE(writer->close().status);
  EXPECT_LT(fs::file_size(in("x.mcap")), 100'000U);
  EXPECT_EQ(play(in("x.mcap")).messages.size(), 1U);
}

TEST_F(Mcap, AStreamIsReadAlone) {
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

TEST_F(Mcap, TheSummarySaysWhatIsThere) {
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

TEST_F(Mcap, AFileThatIsCutOffIsReadUpToItsLastWholeChunk) {
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

TEST_F(Mcap, FilesThatAreCutOffAreMergedByTimeAndSaidOnce) {
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

TEST_F(Mcap, AFileThatIsCutOffEndsOnce) {
  record_images(in("x.mcap"), 3);
  write("cut.mcap", without_end(bytes_of(in("x.mcap"))));
  auto source = must(open_source(in("cut.mcap"), {}));
  Message message;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(*source->take(message), Got::Message);
  EXPECT_EQ(source->take(message).error().code, Code::Truncated);
  ASSERT_TRUE(source->resume());
  EXPECT_EQ(*source->take(message), Got::End);
}

TEST_F(Mcap, AMessageIsInTheChunkOfItsCompanion) {
  const auto all = record_images(in("x.mcap"), 20, chunks_of(1 << 20));
  auto writer = writer_of(in("y.mcap"), chunks_of(1));
  auto reader = *Reader::open({place_of(in("x.mcap"))}, {}, writer->copied_topics());
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

TEST_F(Mcap, DamageIsFoundAndPassedOver) {
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

TEST_F(Mcap, HostileFilesCostNoMemory) {
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

TEST_F(Mcap, RecordsThatNoChunkHasAreNotKept) {
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

TEST_F(Mcap, FilesOfOthersAreReadWholeAndByTime) {
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

TEST_F(Mcap, CompanionsWithoutTheirMessagesAreCopied) {
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

TEST_F(Mcap, AMessageAndItsCompanionAreFoundInAnyOrderAndChunks) {
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

TEST_F(Mcap, TopicsOfOneNameAndTwoDefinitionsStayTwo) {
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

TEST_F(Mcap, WhatCannotBeReadIsSaid) {
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

TEST_F(Mcap, ALongRecordingOfTinyChunksIsRead) {
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

TEST_F(Mcap, AChunkWhoseIndexIsCutOffIsReadForAStream) {
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

TEST_F(Mcap, APipeIsRefusedAtOnce) {
  ASSERT_EQ(::mkfifo((in("x.mcap")).c_str(), 0600), 0);
  EXPECT_EQ(play(in("x.mcap")).error->code, Code::Unsupported);
}

TEST_F(Mcap, StreamsNeverShareATopic) {
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

TEST_F(Mcap, TracesHaveNoTopicForViewers) {
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

TEST_F(Mcap, StreamsThatHaveNoRoomInAFileAreDropped) {
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

TEST_F(Mcap, AFullDiskEndsTheRecordingWithAValidFile) {
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

TEST_F(Mcap, ARecordingIsSplitAndItsOldestFilesAreRemoved) {
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

TEST_F(Mcap, OfEachStaticFrameTheLatestIsRepeated) {
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

TEST_F(Mcap, StaticFramesThatCannotBeReadAreAllRepeated) {
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

TEST_F(Mcap, OfStaticFramesWithoutEndTheLatestAreRepeatedAndThoseThatCanBeRead) {
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

TEST_F(Mcap, EachJointThatAnOutputMovesIsOnTf) {
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

TEST_F(Mcap, TheLastMetadataOfANameIsFound) {
  auto writer = writer_of(in("x.mcap"), chunks_of());
  ASSERT_TRUE(writer->metadata("a", {{"x", "1"}}));
  ASSERT_TRUE(writer->add(*writer->add_stream("eye"), image(1), unix_time(1)));
  ASSERT_TRUE(writer->metadata("b", {{"x", "2"}}));
  ASSERT_TRUE(writer->metadata("a", {{"x", "3"}}));
  ASSERT_TRUE(writer->close().status);
  EXPECT_EQ(*mcap::Reader::open(in("x.mcap"))->metadata(),
            (std::map<std::string, StringMap>{{"a", {{"x", "3"}}}, {"b", {{"x", "2"}}}}));
}

TEST_F(Mcap, NumberedFilesOfBeforeStay) {
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

TEST_F(Mcap, WhatWasLastIsSaved) {
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
  ASSERT_TRUE(writer->close().status);
  auto played = play(in("x_0001.mcap"));
  EXPECT_FALSE(played.error);
  EXPECT_GE(played.messages.size(), 10U);
  EXPECT_LE(played.messages.size(), 15U);  // whole chunks
  EXPECT_EQ(played.messages.back(), encode(image(59)));
  const auto summary = summary_of(in("x_0001.mcap"));
  EXPECT_LE(summary.end - summary.begin, 15'000'000'000U);  // lasting messages get the start time
  EXPECT_EQ(topics_of(summary)["/tf_static"], 1U);
  EXPECT_EQ(play(in("x_0002.mcap")).messages.back(), encode(image(69)));
}

TEST_F(Mcap, NothingIsSavedAfterTheEnd) {
  std::vector<std::string> said;
  auto options = chunks_of();
  options.last = std::chrono::seconds(10);
  options.log = [&](Level, std::string_view line) { said.emplace_back(line); };
  auto writer = writer_of(in("x.mcap"), options);
  ASSERT_TRUE(writer->close().status);
  writer->save();
  EXPECT_EQ(said, std::vector<std::string>{"not saved: the recording has ended"});
}

TEST_F(Mcap, Crc32IsThatOfZlib) {
  const std::string_view text = "123456789";
  EXPECT_EQ(mcap::crc32(std::as_bytes(std::span(text))), 0xcbf43926U);
  EXPECT_EQ(mcap::crc32(std::as_bytes(std::span(text).subspan(3)),
                        mcap::crc32(std::as_bytes(std::span(text).first(3)))),
            0xcbf43926U);
}

TEST_F(Mcap, OtherFilesAreRefused) {
  write("x.mcap", "1 7 0 0 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n");
  EXPECT_EQ(play(in("x.mcap")).error->code, Code::Malformed);
  EXPECT_EQ(play(in("none.mcap")).error->code, Code::NotFound);
  EXPECT_EQ(play(in("x.mcap?keep=all")).error->code, Code::Invalid);
}

}  // namespace
}  // namespace hc::record
