// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stores chunks: in one file, in a sequence of files, or in memory until they are saved.

#include <chrono>
#include <cstdint>
#include <deque>
#include <list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <hc/base/result.h>
#include <record/mcap/file.h>

namespace hc::mcap {

struct StorageOptions {
  std::uint64_t split = 0;  ///< begin a new file beyond this size [byte]; 0: never
  std::uint64_t keep = 0;   ///< remove the oldest files beyond this total size [byte]; 0: never
  /// > 0: keep messages of this duration in memory; each save() writes them to a file.
  std::chrono::nanoseconds last{0};
  std::string profile = "ros2";
};

/// A message that remains valid, such as fixed frames ("latched" in ROS).
struct Lasting {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;  ///< [ns since the Unix epoch]
  std::vector<std::byte> data;
  /// Its subjects, such as frames. It is dropped once later messages cover them all; empty: never.
  std::set<std::string> about;
};

/// Parses a number of bytes, optionally with K, M or G (of 1024); empty is 0. Errors: Invalid.
Result<std::uint64_t> parse_bytes(std::string_view text);

class Storage {
 public:
  /// The contents of each file: all schemas and channels, the latest metadata of each name, and
  /// lasting messages, which get the start time of the file from the second file on. There is at
  /// most one per subject and kMostLasting in all; the oldest without subjects are dropped first.
  using Repeated = std::variant<SchemaRecord, ChannelRecord, MetadataRecord, Lasting>;
  /// Limit on lasting messages, each with an overhead of kLastingOverhead. [byte]
  static constexpr std::size_t kMostLasting = std::size_t{1} << 20, kLastingOverhead = 512;

  /// @param file  "kept.mcap". If it has contents, a new file is written beside it (os/new_file.h).
  ///     With `split` or `last`: "kept_0001.mcap" and so on, after existing ones.
  /// Errors: System; Invalid (`keep` without `split`; `last` with either).
  static Result<Storage> make(const std::string& file, const StorageOptions& options);

  // Errors of all: System. Then only close() may be called, which leaves a valid file; after save()
  // also the others.

  Status add(Repeated record);
  Status add(Chunk chunk);

  /// With `last`: writes the messages in memory to a file; returns its name.
  Result<std::string> save();
  Status close();

  // After close(), of the files written and not removed:
  [[nodiscard]] std::vector<std::string> files() const;
  /// Their messages of MTP; one that several files have counts once.
  [[nodiscard]] std::uint64_t messages() const;
  /// The file being written; with `split` or `last`, the name without number.
  [[nodiscard]] const std::string& file() const { return name_; }

 private:
  Storage(std::string name, StorageOptions options)
      : name_(std::move(name)), options_(std::move(options)) {}
  [[nodiscard]] bool is_numbered() const { return options_.split > 0 || options_.last.count() > 0; }
  /// @param time  of lasting messages. [ns since the Unix epoch]
  Status begin_file(std::uint64_t time);
  Status end_file();
  Status write(const Chunk& chunk);
  Status write(const Repeated& record, std::uint64_t time);
  /// Drops lasting messages beyond kMostLasting.
  void limit_lasting();
  void remove_old();

  struct Done {
    std::string path;
    std::uint64_t size = 0, messages = 0;
  };

  std::string name_;
  StorageOptions options_;
  std::list<Repeated> repeated_;
  std::optional<File> file_;
  std::uint64_t in_file_ = 0;  // messages
  std::deque<Done> done_;
  std::deque<Chunk> memory_;
  std::uint64_t in_memory_ = 0;  // [byte]
  std::uint64_t number_ = 0;     // of the last file
};

}  // namespace hc::mcap
