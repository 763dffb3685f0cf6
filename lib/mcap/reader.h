// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads MCAP files: their summary, and their messages in the order of the file. A file without its
// end, as a crash leaves it, is read up to its last whole chunk. Whatever a file holds, memory is
// bounded by the limits.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>
#include <mcap/chunk.h>
#include <mcap/file.h>

namespace hc::mcap {

struct ReaderLimits {
  std::uint64_t chunk_bytes = std::uint64_t{512} << 20;   ///< of a chunk or message, plain
  std::uint64_t summary_bytes = std::uint64_t{64} << 20;  ///< of schemas and channels
};

/// What a file says of itself.
struct Summary {
  std::string library;
  std::map<std::uint16_t, SchemaRecord> schemas;
  std::map<std::uint16_t, ChannelRecord> channels;
  std::map<std::uint16_t, std::uint64_t> counts;  ///< of messages, by channel
  std::uint64_t messages = 0;
  std::uint64_t begin = 0, end = 0;  ///< log times [ns since the Unix epoch]
  std::uint64_t chunks = 0;          ///< how many
  std::uint64_t plain = 0;           ///< what they hold, expanded [byte]
  std::uint64_t metadata = 0;        ///< how many records
  std::string first_metadata;        ///< name of one
  bool is_whole = false;  ///< the file has its end; otherwise all this was found by going through
};

/// A message, in the memory of its chunk.
struct StoredMessage {
  MessageRecord record;
  std::span<const std::byte> data;
  std::shared_ptr<const void> owner;
};

class Reader {
 public:
  /// Errors: NotFound, System; Malformed (no MCAP file).
  static Result<Reader> open(const std::string& path, const ReaderLimits& limits = {});

  /// Reads the summary; of a file that has none, what goes before.
  /// Errors: Malformed, TooLarge, System. Cost: without a summary, a look at each record's head.
  Result<Summary> summary();

  /// The last metadata of a name; nothing where there is none. Cost: as of a file without a
  /// summary. Errors: Malformed, TooLarge, System.
  Result<std::optional<Words>> metadata(std::string_view name);

  /// Reads these channels alone: chunks without any are skipped where the whole index behind them
  /// says so.
  void select(std::set<std::uint16_t> channels) { selected_ = std::move(channels); }

  /// The next message in the order of the file; nothing at its end. Schemas and channels that came
  /// before it are in `found`.
  ///
  /// Errors: Truncated (the file has no end; everything before was read), Malformed, TooLarge,
  /// Unsupported, System. Read on after Malformed, TooLarge and Unsupported: at the next record.
  Result<std::optional<StoredMessage>> next();

  /// What next() has passed.
  Summary found;

  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// How far next() is. [byte]
  [[nodiscard]] std::uint64_t position() const { return at_; }

 private:
  struct RecordPlace {
    Opcode opcode{};
    std::uint64_t content = 0, length = 0;  // where the content is
    [[nodiscard]] std::uint64_t end() const { return content + length; }
  };

  Reader(std::string path, internal::Descriptor descriptor, std::uint64_t size,
         const ReaderLimits& limits)
      : path_(std::move(path)), descriptor_(std::move(descriptor)), size_(size), limits_(limits) {}

  [[nodiscard]] Error damaged(const std::string& what, std::uint64_t at) const;
  [[nodiscard]] Error truncated(std::uint64_t at) const;
  Result<std::vector<std::byte>> read(std::uint64_t at, std::uint64_t size, std::uint64_t limit);
  /// The record at a place of the file. Errors: Truncated, System.
  Result<RecordPlace> record_at(std::uint64_t at);
  /// Takes what is no message into `summary`. Errors: Malformed.
  Status take(Opcode opcode, std::span<const std::byte> content, Summary& summary,
              std::uint64_t at);
  Result<bool> read_end(Summary& summary);
  /// Whether the indexes behind a chunk, up to the next record, say that nothing selected is in it.
  Result<bool> is_skipped(const RecordPlace& chunk);
  Result<Summary> go_through();
  Result<std::optional<StoredMessage>> next_of_chunk();
  Status open_chunk(const RecordPlace& place);

  std::string path_;
  internal::Descriptor descriptor_;
  std::uint64_t size_ = 0;
  ReaderLimits limits_;
  std::uint64_t at_ = 8;    // behind the magic
  std::uint64_t kept_ = 0;  // of schemas and channels [byte]
  std::optional<std::set<std::uint16_t>> selected_;
  std::shared_ptr<const std::vector<std::byte>> chunk_;
  std::uint64_t chunk_begin_ = 0;  // in the file
  std::size_t chunk_at_ = 0;
};

}  // namespace hc::mcap
