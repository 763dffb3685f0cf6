// SPDX-License-Identifier: Apache-2.0
#pragma once
// Helpers for tests of recordings.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <hc/mtp/codec.h>
#include <hc/testing/files.h>
#include <hc/testing/must.h>
#include <record/writer.h>

namespace hc::record {

/// The contents of a recording: stream, bytes and log time of each message; and the final error.
struct Played {
  std::vector<std::string> streams, messages;
  std::vector<Time> times;
  std::optional<Error> error;
  [[nodiscard]] std::chrono::nanoseconds duration() const { return times.back() - times.front(); }
};

inline std::vector<Place> places_of(const std::vector<std::string>& words) {
  std::vector<Place> places(words.size());
  std::ranges::transform(words, places.begin(),
                         [](const auto& word) { return must(place_of(word)); });
  return places;
}

inline Played play(const std::vector<std::string>& words, Time from = {}) {
  Played all;
  auto reader = Reader::open(places_of(words), {});
  if (!reader) {
    all.error = reader.error();
    return all;
  }
  (*reader)->start_at(from);
  Message message;
  while (true) {
    auto got = (*reader)->take(message);
    if (!got) all.error = got.error();
    if (!got || *got != Got::Message) return all;
    all.streams.emplace_back((*reader)->stream());
    all.messages.push_back(encode(message));
    all.times.push_back((*reader)->log_time());
  }
}
inline Played play(const std::string& word) {
  return play(std::vector{word});
}

inline std::unique_ptr<Writer> writer_of(const Place& place, const WriterOptions& options = {}) {
  auto writer = Writer::open(place, options);
  EXPECT_TRUE(writer) << writer.error().text();
  return writer ? std::move(*writer) : nullptr;
}
inline std::unique_ptr<Writer> writer_of(const std::string& word,
                                         const WriterOptions& options = {}) {
  return writer_of(must(place_of(word)), options);
}

inline mcap::Summary summary_of(const std::string& path, const mcap::ReaderLimits& limits = {}) {
  auto reader = mcap::Reader::open(path, limits);
  EXPECT_TRUE(reader) << reader.error().text();
  return reader ? reader->summary() : mcap::Summary();
}
/// The number of messages per topic.
inline std::map<std::string, std::uint64_t> topics_of(const mcap::Summary& summary) {
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [id, channel] : summary.channels)
    if (summary.counts.contains(id)) counts[channel.topic] += summary.counts.at(id);
  return counts;
}

/// A test with a temporary folder.
class Recordings : public ::testing::Test {
 protected:
  /// A path in the folder.
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  /// Writes a file; returns its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    auto path = in(name);
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  /// Copies recordings into a new one, as `hc record` does.
  [[nodiscard]] Written copied(const std::vector<std::string>& words, const std::string& name,
                               const WriterOptions& options = {}) const {
    auto writer = writer_of(in(name), options);
    auto reader = Reader::open(places_of(words), {}, writer->copied_topics());
    EXPECT_TRUE(reader) << reader.error().text();
    EXPECT_TRUE(writer->copy_head(**reader));
    for (auto copied = Result<bool>(true); copied && *copied;) copied = writer->copy(**reader);
    EXPECT_TRUE(writer->close().status);
    return writer->written();
  }
  /// As copied(); returns the place of the new one.
  [[nodiscard]] std::string copy(const std::vector<std::string>& words,
                                 const std::string& name) const {
    return copied(words, name).place;
  }

 private:
  Folder folder_;
};

inline Message message_of(const Info& info, std::int32_t width, std::int32_t height,
                          std::int64_t seq, std::mt19937& random) {
  auto draft = Draft::make(info, height, width);
  draft.header.seq = seq;
  draft.header.src = 7;
  draft.header.time = unix_time(1'763'683'200'000'000'000 + seq);
  for (auto& each : draft.elements()) each = static_cast<std::byte>(random());
  if (info.encoding == Encoding::Text)  // no NaN, whose bits text does not preserve
    for (auto& each : draft.elements()) each = static_cast<std::byte>(random() % 64);
  return std::move(draft).finish();
}

inline Message image(std::int64_t seq, std::int32_t width = 40) {
  std::mt19937 random(static_cast<unsigned>(seq));
  return message_of({MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}, width, 30, seq,
                    random);
}

inline WriterOptions chunks_of(std::size_t bytes = 10000) {
  WriterOptions options;
  options.chunk_bytes = bytes;
  return options;
}

/// Records images 0 … count - 1 at 1 ns, 2 ns, …; returns the bytes of each.
inline std::vector<std::string> record_images(const std::string& file, int count,
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

}  // namespace hc::record
