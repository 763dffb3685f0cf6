// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include <hc/mtp/codec.h>
#include <mcap/link.h>
#include <mcap/recorder.h>
#include <ros/cdr.h>
#include <ros/messages.h>

namespace hc::mcap {
namespace {

namespace fs = std::filesystem;

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "hc-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }

 private:
  fs::path path_;
};

Message message_of(const Info& info, std::int32_t width, std::int32_t height, std::int64_t seq,
                   std::mt19937& random) {
  auto draft = Draft::make(info, width, height);
  draft.header.seq = seq;
  draft.header.src = 7;
  draft.header.time = 1'763'683'200'000'000'000 + seq;
  for (auto& each : draft.elements()) each = static_cast<std::byte>(random());
  if (info.encoding == Encoding::Text)  // a NaN has one spelling
    for (auto& each : draft.elements()) each = static_cast<std::byte>(random() % 64);
  return std::move(draft).finish();
}

Message image(std::int64_t seq, std::int32_t width = 40) {
  std::mt19937 random(static_cast<unsigned>(seq));
  return message_of({MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}, width, 30, seq,
                    random);
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What a recording gives: its messages in bytes, and why it ended.
struct Played {
  std::vector<std::string> messages;
  std::optional<Error> error;
};

Played play(const std::string& uri) {
  Played played;
  auto source = read_recording(*parse_uri(uri));
  if (!source) {
    played.error = source.error();
    return played;
  }
  Message message;
  while (true) {
    auto got = (*source)->take(message);
    if (!got) played.error = got.error();
    if (!got || *got == Got::End) return played;
    played.messages.push_back(encode(message));
  }
}

std::unique_ptr<Recorder> recorder_of(const std::string& file, std::size_t chunk_bytes = 10000) {
  RecorderOptions options;
  options.file = file;
  options.chunk_bytes = chunk_bytes;
  return std::move(*Recorder::make(options));
}

/// Records images 0 … count - 1; the bytes of each.
std::vector<std::string> record_images(const std::string& file, int count) {
  auto recorder = recorder_of(file);
  const auto stream = recorder->add_stream("eye.left");
  std::vector<std::string> all;
  for (int i = 0; i < count; ++i) {
    const auto message = image(i);
    EXPECT_TRUE(recorder->record(stream, message, message.header.time));
    all.push_back(encode(message));
  }
  EXPECT_TRUE(recorder->close());
  return all;
}

TEST(Mcap, EveryMessageComesOutAsItWentIn) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap");
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp)
  std::vector<std::string> all;
  for (int type = 1; type <= 12; ++type)
    for (int scalar = 0; scalar < 10; ++scalar)
      for (int encoding = 0; encoding < 4; ++encoding)
        for (int components : {1, 2, 3, 6}) {
          const Info info{static_cast<MatrixType>(type), static_cast<std::uint8_t>(components),
                          static_cast<Scalar>(scalar), static_cast<Encoding>(encoding)};
          if (broken_rule(info) != 0) continue;
          const auto stream = recorder->add_stream("m.p" + std::to_string(info.code()));
          for (const auto& [width, height] : {std::pair(1, 1), {4, 4}, {1, 0}, {1, 3}, {5, 1}}) {
            Header header;
            header.info = info;
            header.width = width;
            header.height = height;
            if (!check(header)) continue;
            auto message = message_of(info, width, height, static_cast<int>(random() % 9), random);
            message.header.coord = static_cast<std::int32_t>(random() % 15);
            ASSERT_TRUE(recorder->record(stream, message, 1));
            all.push_back(encode(message));
          }
        }
  ASSERT_TRUE(recorder->close());
  const auto played = play(folder / "x.mcap");
  EXPECT_FALSE(played.error) << played.error->text();
  ASSERT_GT(all.size(), 900U);
  EXPECT_EQ(played.messages, all);
}

TEST(Mcap, NoImageIsStoredTwice) {
  Folder folder;
  const auto all = record_images(folder / "x.mcap", 20);  // of random pixels, so nothing gets less
  EXPECT_LT(static_cast<double>(fs::file_size(folder / "x.mcap")),
            1.1 * static_cast<double>(20 * all[0].size()) + 5000);
}

TEST(Mcap, AStreamIsReadAlone) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap");
  const auto left = recorder->add_stream("eye.left"), right = recorder->add_stream("eye.right");
  std::vector<std::string> all;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(recorder->record(left, image(i), i));
    if (i < 10) continue;
    ASSERT_TRUE(recorder->record(right, image(100 + i), i));
    all.push_back(encode(image(100 + i)));
  }
  ASSERT_TRUE(recorder->close());
  EXPECT_EQ(play(folder / "x.mcap?stream=eye.right").messages, all);
  EXPECT_EQ(play(folder / "x.mcap").messages.size(), 30U);
  const auto wrong = play(folder / "x.mcap?stream=eye.rght");
  ASSERT_TRUE(wrong.error);
  EXPECT_EQ(wrong.error->code, Code::NotFound);
  EXPECT_NE(wrong.error->detail.find("did you mean \"eye.right\"?"), std::string::npos);
}

TEST(Mcap, TheSummarySaysWhatIsThere) {
  Folder folder;
  record_images(folder / "x.mcap", 20);
  auto reader = Reader::open(folder / "x.mcap");
  ASSERT_TRUE(reader);
  const auto summary = reader->summary();
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_TRUE(summary->is_whole);
  EXPECT_EQ(summary->messages, 40U);
  EXPECT_EQ(summary->end - summary->begin, 19U);
  const auto found = streams(*summary);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "eye.left");
  EXPECT_EQ(found[0].topic, "/eye/left");
  EXPECT_EQ(found[0].type, "sensor_msgs/msg/Image");
  EXPECT_EQ(found[0].messages, 20U);
}

TEST(Mcap, AFileThatIsCutOffIsReadUpToItsLastWholeChunk) {
  Folder folder;
  const auto all = record_images(folder / "x.mcap", 12);
  const std::string whole = bytes_of(folder / "x.mcap");
  std::size_t most = 0;
  for (std::size_t size = 0; size < whole.size(); size += size < 2000 ? 1 : 97) {
    std::ofstream(folder / "cut.mcap", std::ios::binary) << whole.substr(0, size);
    const auto played = play(folder / "cut.mcap");
    ASSERT_LE(played.messages.size(), all.size());
    ASSERT_GE(played.messages.size(), most);  // more bytes, no fewer messages
    most = played.messages.size();
    for (std::size_t i = 0; i < most; ++i) ASSERT_EQ(played.messages[i], all[i]);
    if (!played.error) continue;  // all chunks and the record that ends them are there
    ASSERT_EQ(played.error->code, size < 8 ? Code::Malformed : Code::Truncated) << size;
  }
  EXPECT_EQ(most, all.size());
}

TEST(Mcap, DamageIsFoundAndPassedOver) {
  Folder folder;
  const auto all = record_images(folder / "x.mcap", 12);
  std::string damaged = bytes_of(folder / "x.mcap");
  damaged[damaged.size() / 2] ^= 1;
  std::ofstream(folder / "damaged.mcap", std::ios::binary) << damaged;
  auto source = read_recording(*parse_uri(folder / "damaged.mcap"));
  ASSERT_TRUE(source);
  Message message;
  int errors = 0, messages = 0;
  while (true) {
    auto got = (*source)->take(message);
    if (got && *got == Got::End) break;
    if (got) {
      ++messages;
      continue;
    }
    EXPECT_EQ(got.error().code, Code::Malformed);
    ++errors;
    ASSERT_TRUE((*source)->resume());
  }
  EXPECT_EQ(errors, 1);
  EXPECT_GE(messages, 8);
  EXPECT_LT(messages, 12);
}

TEST(Mcap, HostileFilesCostNoMemory) {
  Folder folder;
  record_images(folder / "x.mcap", 3);
  const std::string whole = bytes_of(folder / "x.mcap");
  std::mt19937 random(3);  // NOLINT(cert-msc51-cpp)
  for (int round = 0; round < 3000; ++round) {
    std::string hostile = whole;
    for (int i = 0; i < 3; ++i) {
      const bool near_end = random() % 2 == 0;
      const std::size_t at = near_end ? hostile.size() - 1 - random() % 1500 : random() % 2000;
      hostile[at] = static_cast<char>(random() % 3 == 0 ? 0xff : random());
    }
    std::ofstream(folder / "y.mcap", std::ios::binary) << hostile;
    auto source = read_recording(*parse_uri(folder / "y.mcap"));
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
  EXPECT_LT(usage.ru_maxrss, 700 << 10);  // [KiB]
}

TEST(Mcap, RecordsThatNoChunkHasAreNotKept) {
  Folder folder;
  RecordWriter plain;
  for (int i = 0; i < 1000; ++i) {
    plain.begin(Opcode::ChunkIndex);
    plain.append(std::vector<std::byte>(72));
    plain.end();
    plain.begin(Opcode::MetadataIndex);
    plain.append(std::vector<std::byte>(20));
    plain.end();
  }
  RecordWriter out;
  out.append(std::as_bytes(std::span(kMagic)));
  out.begin(Opcode::Chunk);
  out.number(std::uint64_t{0});
  out.number(std::uint64_t{0});
  out.number(std::uint64_t{plain.bytes.size()});
  out.number(crc32(plain.bytes));
  out.string("");
  out.number(std::uint64_t{plain.bytes.size()});
  out.append(plain.bytes);
  out.end();
  out.begin(Opcode::DataEnd);
  out.number(std::uint32_t{0});
  out.end();
  std::ofstream(folder / "x.mcap", std::ios::binary)
      .write(reinterpret_cast<const char*>(out.bytes.data()),
             static_cast<std::streamsize>(out.bytes.size()));
  auto reader = Reader::open(folder / "x.mcap");
  ASSERT_TRUE(reader);
  const auto end = reader->next();
  ASSERT_TRUE(end) << end.error().text();
  EXPECT_FALSE(*end);
  EXPECT_EQ(reader->position(), out.bytes.size() - kRecordHead - 4);
  EXPECT_EQ(reader->found.chunks, 0U);
  EXPECT_EQ(reader->found.metadata, 0U);
}

TEST(Mcap, ALongRecordingOfTinyChunksIsRead) {
  Folder folder;
  constexpr int kCount = 500;
  auto recorder = recorder_of(folder / "x.mcap", 1);
  const auto stream = recorder->add_stream("eye.left");
  for (int i = 0; i < kCount; ++i) ASSERT_TRUE(recorder->record(stream, image(i, 1), i + 1));
  ASSERT_TRUE(recorder->close());
  ReaderLimits limits;
  limits.summary_bytes = 10000;  // far less than the index of the chunks
  auto reader = Reader::open(folder / "x.mcap", limits);
  ASSERT_TRUE(reader);
  auto summary = reader->summary();
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_EQ(summary->chunks, kCount);
  const std::string whole = bytes_of(folder / "x.mcap");
  std::ofstream(folder / "cut.mcap", std::ios::binary) << whole.substr(0, whole.size() / 2);
  reader = Reader::open(folder / "cut.mcap", limits);
  summary = reader->summary();
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_FALSE(summary->is_whole);
  EXPECT_GT(summary->chunks, 100U);
}

TEST(Mcap, AChunkWhoseIndexIsCutOffIsReadForAStream) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap", 1 << 20);
  const auto left = recorder->add_stream("eye.left"), right = recorder->add_stream("eye.right");
  ASSERT_TRUE(recorder->record(left, image(1), 1));
  ASSERT_TRUE(recorder->record(right, image(2), 2));
  ASSERT_TRUE(recorder->close());
  std::string cut = bytes_of(folder / "x.mcap");
  std::size_t at = kMagic.size();
  int indexes = 0;
  while (indexes < 2) {  // those of the left eye
    indexes += static_cast<Opcode>(cut[at]) == Opcode::MessageIndex ? 1 : 0;
    std::uint64_t length = 0;
    std::memcpy(&length, cut.data() + at + 1, sizeof length);
    at += kRecordHead + length;
  }
  cut.resize(at);
  std::ofstream(folder / "cut.mcap", std::ios::binary) << cut;
  const auto played = play(folder / "cut.mcap?stream=eye.right");
  EXPECT_EQ(played.messages, std::vector{encode(image(2))});
}

TEST(Mcap, APipeIsRefusedAtOnce) {
  Folder folder;
  ASSERT_EQ(::mkfifo((folder / "x.mcap").c_str(), 0600), 0);
  EXPECT_EQ(play(folder / "x.mcap").error->code, Code::Unsupported);
}

TEST(Mcap, StreamsNeverShareATopic) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap");
  std::vector<std::string> all;
  int number = 0;
  for (const char* name : {"a", "a.mtp", "a.mtp.mtp", "a", "b.mtp", "b", "tf", "b.compressed"}) {
    const auto stream = recorder->add_stream(name);
    ASSERT_TRUE(recorder->record(stream, image(++number), 1));
    all.push_back(encode(image(number)));
  }
  ASSERT_TRUE(recorder->close());
  EXPECT_EQ(play(folder / "x.mcap").messages, all);
  EXPECT_EQ(play(folder / "x.mcap?stream=a.mtp").messages, std::vector{all[1]});
  EXPECT_EQ(play(folder / "x.mcap?stream=b").messages, std::vector{all[5]});
  auto reader = Reader::open(folder / "x.mcap");
  std::set<std::string> topics;
  const auto summary = reader->summary();
  for (const auto& [id, channel] : summary->channels) topics.insert(channel.topic);
  EXPECT_EQ(topics.size(), summary->channels.size());
}

TEST(Mcap, TracesHaveNoTopicForViewers) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap");
  std::vector<std::string> all;
  for (const char* name : {"eye.trace", "eye.left"}) {
    ASSERT_TRUE(recorder->record(recorder->add_stream(name), image(1), 1));
    all.push_back(encode(image(1)));
  }
  ASSERT_TRUE(recorder->close());
  EXPECT_EQ(play(folder / "x.mcap").messages, all);
  auto reader = Reader::open(folder / "x.mcap");
  std::set<std::string> topics;
  const auto summary = reader->summary();
  for (const auto& [id, channel] : summary->channels) topics.insert(channel.topic);
  EXPECT_EQ(topics, (std::set<std::string>{"/eye/left", "/eye/left/mtp", "/eye/trace/mtp"}));
}

TEST(Mcap, StreamsThatHaveNoRoomInAFileAreRefused) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap", 1 << 20);
  const auto message = image(0, 1);
  Status status;
  std::size_t recorded = 0;
  for (; recorded < 40000; ++recorded) {
    status = recorder->record(recorder->add_stream("s" + std::to_string(recorded)), message, 1);
    if (!status) break;
  }
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::TooLarge);
  EXPECT_TRUE(recorder->record(0, message, 2));
  ASSERT_TRUE(recorder->close());
  EXPECT_EQ(recorder->lost(), 1U);
  EXPECT_EQ(recorder->messages(), recorded + 2);
  const auto played = play(folder / "x.mcap");
  EXPECT_FALSE(played.error) << played.error->text();
  EXPECT_EQ(played.messages.size(), recorded + 1);
  EXPECT_EQ(play(folder / "x.mcap?stream=s0").messages.size(), 2U);
  EXPECT_EQ(streams(*Reader::open(folder / "x.mcap")->summary()).size(), recorded);
}

TEST(Mcap, AFullDiskEndsTheRecordingWithAValidFile) {
  Folder folder;
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 300'000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  auto recorder = recorder_of(folder / "x.mcap");
  const auto stream = recorder->add_stream("eye.left");
  Status status;
  std::vector<std::string> all;
  for (int i = 0; i < 100000 && status; ++i) {
    status = recorder->record(stream, image(i), i + 1);
    all.push_back(encode(image(i)));
  }
  const auto closed = recorder->close();
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().detail.find("File too large"), std::string::npos);
  EXPECT_EQ(closed.error().detail, status.error().detail);
  EXPECT_EQ(recorder->messages(), all.size());
  const auto played = play(folder / "x.mcap");
  EXPECT_FALSE(played.error) << played.error->text();
  ASSERT_GT(played.messages.size(), 70U);
  EXPECT_EQ(played.messages.size() + recorder->lost(), all.size());
  for (std::size_t i = 0; i < played.messages.size(); ++i) ASSERT_EQ(played.messages[i], all[i]);
  auto reader = Reader::open(folder / "x.mcap");
  EXPECT_TRUE(reader->summary()->is_whole);
}

TEST(Mcap, ARecordingIsSplitAndItsOldestFilesAreRemoved) {
  Folder folder;
  RecorderOptions options;
  options.file = folder / "x.mcap";
  options.chunk_bytes = 10000;
  options.split = 50000;
  options.keep = 200000;
  auto recorder = std::move(*Recorder::make(options));
  const auto stream = recorder->add_stream("eye.left");
  ASSERT_TRUE(recorder->set_frames("head 3 robot 1 2 3 0 0 0 1", 1));
  constexpr int kCount = 200;
  for (int i = 0; i < kCount; ++i) ASSERT_TRUE(recorder->record(stream, image(i), i + 1));
  ASSERT_TRUE(recorder->close());
  EXPECT_FALSE(fs::exists(folder / "x_0001.mcap"));
  std::vector<std::string> files;
  std::uintmax_t size = 0;
  for (const auto& file : fs::directory_iterator(folder / "")) {
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
    auto reader = Reader::open(file);
    bool has_frames = false;
    auto summary = reader->summary();
    ASSERT_TRUE(summary);
    for (const auto& [id, channel] : summary->channels)
      has_frames |= channel.topic == "/tf_static" && summary->counts[id] == 1;
    EXPECT_TRUE(has_frames) << file;
  }
  for (std::size_t i = 0; i < messages.size(); ++i)
    EXPECT_EQ(messages[messages.size() - 1 - i], encode(image(kCount - 1 - static_cast<int>(i))));
}

/// A `transformation` along x, from a neck of address 11.
Message pose(std::int32_t coord, double x) {
  auto draft = Draft::make({MatrixType::Transformation, 1, Scalar::F64, Encoding::Binary}, 4, 4);
  draft.header.src = 11;
  draft.header.coord = coord;
  draft.header.time = 1'763'683'200'000'000'000 + coord;
  const std::array<double, 16> T = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::ranges::copy(T, draft.view<double>().numbers().begin());
  return std::move(draft).finish();
}

TEST(Mcap, EachJointThatAnOutputMovesIsOnTf) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap");
  ASSERT_TRUE(recorder->set_frames(
      "head 3 robot neck.pose 11; left_eye 4 head neck.pose 11; cup 200 head 1 2 3 0 0 0 1", 1));
  const auto stream = recorder->add_stream("neck.pose");
  const auto other = recorder->add_stream("arm.pose");
  ASSERT_TRUE(recorder->record(stream, pose(2003, 0.5), 1));
  ASSERT_TRUE(recorder->record(stream, pose(3004, 0.25), 2));
  ASSERT_TRUE(recorder->record(stream, pose(7, 9), 3));    // of no joint
  ASSERT_TRUE(recorder->record(other, pose(2003, 9), 4));  // moves none
  ASSERT_TRUE(recorder->close());
  auto reader = Reader::open(folder / "x.mcap");
  ASSERT_TRUE(reader);
  std::vector<std::string> joints;
  for (auto message = reader->next(); message && *message; message = reader->next()) {
    if (reader->found.channels.at((*message)->record.channel).topic != "/tf") continue;
    const auto tf = ros::CdrReader::read<ros::TfMessage>((*message)->data);
    ASSERT_TRUE(tf) << tf.error().detail;
    for (const auto& each : tf->transforms)
      joints.push_back(each.header.frame_id + " " + each.child_frame_id + " " +
                       std::to_string(each.transform.position.x) + " " +
                       std::to_string(each.header.stamp.nanosec));
  }
  EXPECT_EQ(joints,
            (std::vector<std::string>{"robot head 0.500000 2003", "head left_eye 0.250000 3004"}));
}

TEST(Mcap, TheLastMetadataOfANameIsFound) {
  Folder folder;
  auto recorder = recorder_of(folder / "x.mcap");
  ASSERT_TRUE(recorder->metadata("a", {{"x", "1"}}));
  ASSERT_TRUE(recorder->record(recorder->add_stream("eye"), image(1), 1));
  ASSERT_TRUE(recorder->metadata("b", {{"x", "2"}}));
  ASSERT_TRUE(recorder->metadata("a", {{"x", "3"}}));
  ASSERT_TRUE(recorder->close());
  auto reader = Reader::open(folder / "x.mcap");
  ASSERT_TRUE(reader);
  EXPECT_EQ(**reader->metadata("a"), (Words{{"x", "3"}}));
  EXPECT_EQ(*reader->metadata("c"), std::nullopt);
}

TEST(Mcap, NumberedFilesOfBeforeStay) {
  Folder folder;
  std::ofstream(folder / "x_0007.mcap") << "kept";
  std::ofstream(folder / "x_copy.mcap") << "kept";
  RecorderOptions options;
  options.file = folder / "x.mcap";
  options.last = std::chrono::seconds(10);
  for (int run = 0; run < 2; ++run) {
    auto recorder = std::move(*Recorder::make(options));
    const auto stream = recorder->add_stream("eye.left");
    ASSERT_TRUE(recorder->record(stream, image(run), 1));
    const auto saved = recorder->save();
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(*saved, folder / ("x_000" + std::to_string(8 + run) + ".mcap"));
  }
  EXPECT_EQ(bytes_of(folder / "x_0007.mcap"), "kept");
  EXPECT_EQ(play(folder / "x_0008.mcap").messages, std::vector{encode(image(0))});
  options.last = {};
  options.split = 50000;
  ASSERT_TRUE((*Recorder::make(options))->close());
  EXPECT_TRUE(fs::exists(folder / "x_0010.mcap"));
}

TEST(Mcap, WhatWasLastIsSaved) {
  Folder folder;
  RecorderOptions options;
  options.file = folder / "x.mcap";
  options.chunk_bytes = 10000;
  options.last = std::chrono::seconds(10);
  auto recorder = std::move(*Recorder::make(options));
  const auto stream = recorder->add_stream("eye.left");
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(recorder->record(stream, image(i), i * kSecond));
  auto saved = recorder->save();
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(*saved, folder / "x_0001.mcap");
  for (int i = 60; i < 70; ++i) ASSERT_TRUE(recorder->record(stream, image(i), i * kSecond));
  EXPECT_EQ(*recorder->save(), folder / "x_0002.mcap");
  ASSERT_TRUE(recorder->close());
  auto played = play(*saved);
  EXPECT_FALSE(played.error);
  EXPECT_GE(played.messages.size(), 10U);
  EXPECT_LE(played.messages.size(), 15U);  // whole chunks
  EXPECT_EQ(played.messages.back(), encode(image(59)));
  EXPECT_EQ(play(folder / "x_0002.mcap").messages.back(), encode(image(69)));
}

TEST(Mcap, Crc32IsThatOfZlib) {
  const std::string_view text = "123456789";
  EXPECT_EQ(crc32(std::as_bytes(std::span(text))), 0xcbf43926U);
  EXPECT_EQ(crc32(std::as_bytes(std::span(text).subspan(3)),
                  crc32(std::as_bytes(std::span(text).first(3)))),
            0xcbf43926U);
}

TEST(Mcap, OtherFilesAreRefused) {
  Folder folder;
  std::ofstream(folder / "x.mcap") << "1 7 0 0 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n";
  EXPECT_EQ(play(folder / "x.mcap").error->code, Code::Malformed);
  EXPECT_EQ(play(folder / "none.mcap").error->code, Code::NotFound);
  EXPECT_EQ(play(folder / "x.mcap?keep=all").error->code, Code::Invalid);
  EXPECT_FALSE(recording_uri("x.mtp"));
  EXPECT_FALSE(recording_uri("tcp:x.mcap:1"));
  EXPECT_EQ(recording_uri("a/x.mcap?stream=b.c")->option("stream", ""), "b.c");
}

}  // namespace
}  // namespace hc::mcap
