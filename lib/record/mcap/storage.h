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
  /// More than 0: keep messages in memory for this time; each save() writes them to a file.
  std::chrono::nanoseconds last{0};
};

/// A message that stays valid, such as the fixed frames ("latched" in ROS).
struct Lasting {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;  ///< [ns since the Unix epoch]
  std::vector<std::byte> data;
  /// Later messages about these replace it, all of them together; empty: none does.
  std::set<std::string> about;
};

/// Reads a number of bytes, also with K, M or G (of 1024) behind it; empty is 0. Errors: Invalid.
Result<std::uint64_t> parse_bytes(std::string_view text);

class Storage {
 public:
  /// What each file contains: all schemas and channels, the newest metadata of each name, and
  /// lasting messages, after the first file with the time at which the file begins: at most one for
  /// each thing that they are about, and no more than kMostLasting: the oldest of those about
  /// nothing known are dropped first.
  using Repeated = std::variant<SchemaRecord, ChannelRecord, MetadataRecord, Lasting>;
  /// Of lasting messages, each with kOfLasting for what is around it. [byte]
  static constexpr std::size_t kMostLasting = std::size_t{1} << 20, kOfLasting = 512;

  /// @param file  "kept.mcap". One that has contents stays, and a new one is written beside it
  ///     (os/new_file.h). With `split` or `last`, "kept_0001.mcap" and so on after existing ones.
  /// Errors: System; Invalid (`keep` without `split`; `last` with either).
  static Result<Storage> make(const std::string& file, const StorageOptions& options);

  // Errors of all: System. Only close() may be called then; it leaves a valid file.

  Status add(Repeated record);
  Status add(Chunk chunk);

  /// With `last`: writes what is in memory to a file; returns its name.
  Result<std::string> save();
  Status close();

  /// Files written and not removed, after close().
  [[nodiscard]] std::vector<std::string> files() const;
  /// The file being written; with `split` or `last` the name without numbers.
  [[nodiscard]] const std::string& file() const { return name_; }

 private:
  Storage(std::string name, const StorageOptions& options)
      : name_(std::move(name)), options_(options) {}
  [[nodiscard]] bool is_numbered() const { return options_.split > 0 || options_.last.count() > 0; }
  /// @param time  of lasting messages. [ns since the Unix epoch]
  Status begin_file(std::uint64_t time);
  Status end_file();
  Status write(const Repeated& record, std::uint64_t time);
  /// Forgets what is more than kMostLasting.
  void limit_lasting();
  void remove_old();

  struct Done {
    std::string path;
    std::uint64_t size = 0;
  };

  std::string name_;
  StorageOptions options_;
  std::list<Repeated> repeated_;
  std::optional<File> file_;
  std::deque<Done> done_;
  std::deque<Chunk> memory_;
  std::uint64_t in_memory_ = 0;  // [byte]
  std::uint64_t number_ = 0;     // of the last file
};

}  // namespace hc::mcap
