// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where chunks go: into one file, into one after the other, or into memory until they are saved.

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <record/mcap/file.h>

namespace hc::mcap {

struct StorageOptions {
  /// "kept.mcap", or beside it if that has contents (os/new_file.h); of several, "kept_0001.mcap"
  /// and so on, behind those that are there.
  std::string file;
  std::uint64_t split = 0;  ///< a new file begins when one has so many bytes; 0: one file
  std::uint64_t keep = 0;   ///< of all files together, the oldest are removed; 0: all [byte]
  /// Of the messages before now; more than 0: in memory, and each save() writes a file.
  std::chrono::nanoseconds last{0};
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< of what is kept for `last` [byte]
  int level = 1;                                  ///< of zstd
};

/// A message that holds until another one replaces it, and so is in each file: with the time at
/// which the file begins, but in the first.
struct Lasting {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;  ///< [ns since the Unix epoch]
  std::vector<std::byte> data;
};

/// A number of bytes with K, M or G (of 1024) behind it, or nothing; of an empty text 0.
/// Errors: Invalid.
Result<std::uint64_t> parse_bytes(std::string_view text);

/// Keeps chunks. Schemas, channels, metadata and lasting messages are in each of its files.
class Storage {
 public:
  /// Errors: System; Invalid (`keep` without `split`; `last` with either).
  static Result<Storage> make(const StorageOptions& options);

  // Errors of all: System. Nothing is written any more then; close() gives a file that is valid.

  Status add(SchemaRecord schema);
  Status add(ChannelRecord channel);
  Status add(MetadataRecord metadata);
  Status add(Lasting message);
  Status add(const ChunkBuilder& chunk);

  /// Writes what is in memory into a file; gives its name. For `last` alone.
  Result<std::string> save();
  Status close();

  /// Messages of MTP that could not be written.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// Those that were written and are not removed, after close().
  [[nodiscard]] std::vector<std::string> files() const;
  /// The file that is being written; of several the name they are numbered after.
  [[nodiscard]] const std::string& file() const {
    return file_ && !is_numbered() ? file_->path() : options_.file;
  }

 private:
  explicit Storage(StorageOptions options)
      : options_(std::move(options)), packer_(std::make_unique<ChunkPacker>(options_.level)) {}
  [[nodiscard]] bool is_numbered() const { return options_.split > 0 || options_.last.count() > 0; }
  /// @param time  at which it begins. [ns since the Unix epoch]
  Status begin_file(std::uint64_t time);
  Status end_file();
  Status write(const Lasting& message, std::uint64_t time);
  void remove_old();

  struct Done {
    std::string path;
    std::uint64_t size = 0;
  };

  StorageOptions options_;
  std::vector<SchemaRecord> schemas_;
  std::vector<ChannelRecord> channels_;
  std::map<std::string, MetadataRecord> metadata_;  // the newest of each name
  std::vector<Lasting> lasting_;
  std::unique_ptr<ChunkPacker> packer_;
  std::optional<File> file_;
  std::deque<Done> done_;
  std::deque<PackedChunk> memory_;
  std::uint64_t in_memory_ = 0, lost_ = 0;
  std::uint64_t number_ = 0;  // of the last file
};

}  // namespace hc::mcap
