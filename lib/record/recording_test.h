// SPDX-License-Identifier: Apache-2.0
#pragma once
// What tests of recordings share.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/mtp/codec.h>
#include <record/writer.h>

namespace hc::record {

/// What a recording holds: of each message its stream, bytes and log time; and why it ended.
struct Played {
  std::vector<std::string> streams, messages;
  std::vector<std::int64_t> times;
  std::optional<Error> error;
  [[nodiscard]] std::int64_t duration() const { return times.back() - times.front(); }
};

inline Played play(const std::vector<std::string>& words, std::int64_t from = 0) {
  Played all;
  std::vector<Place> places;
  for (const auto& word : words) places.push_back(place_of(word));
  auto reader = Reader::open(places, {});
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
  return writer_of(place_of(word), options);
}

inline mcap::Summary summary_of(const std::string& path, const mcap::ReaderLimits& limits = {}) {
  auto reader = mcap::Reader::open(path, limits);
  EXPECT_TRUE(reader) << reader.error().text();
  return reader ? reader->summary() : mcap::Summary();
}
/// How many messages each topic has.
inline std::map<std::string, std::uint64_t> topics_of(const mcap::Summary& summary) {
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [id, channel] : summary.channels)
    if (summary.counts.contains(id)) counts[channel.topic] = summary.counts.at(id);
  return counts;
}

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Limits the size of files as long as it exists, as if the disk were full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &before_), 0);
    const rlimit limit{bytes, before_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }

 private:
  rlimit before_{};
  void (*signal_)(int);
};

/// Has a folder that is removed after the test.
class Recordings : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "hc-test-XXXXXX").string();
    root_ = ::mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  /// A path in it.
  [[nodiscard]] std::string in(const std::string& name) const { return (root_ / name).string(); }
  /// Writes a file; gives its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    const auto path = in(name);
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  /// Copies recordings into another, as `hc record` does; where that is.
  [[nodiscard]] std::string copy(const std::vector<std::string>& words,
                                 const std::string& name) const {
    std::vector<Place> places;
    for (const auto& word : words) places.push_back(place_of(word));
    auto writer = writer_of(in(name));
    auto reader = Reader::open(places, {}, writer->copied_topics());
    EXPECT_TRUE(reader) << reader.error().text();
    for (auto copied = Result<bool>(true); copied && *copied;) copied = writer->copy(**reader);
    EXPECT_TRUE(writer->close().status);
    return writer->written().place;
  }

 private:
  std::filesystem::path root_;
};

}  // namespace hc::record
