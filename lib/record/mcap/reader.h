// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads MCAP files, whoever wrote them: their summary, and their messages in the order of their log
// times. A file without its end, as a crash leaves it, is read up to its last whole chunk. Whatever
// a file holds, memory is bounded by the limits and by the number of its chunks.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>
#include <record/mcap/chunk.h>
#include <record/mcap/file.h>

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
  bool is_whole = false;             ///< the file has its end
  std::uint64_t unread = 0;          ///< chunks whose contents are not counted, as they cannot be
  std::string why_unread;            ///< read, and why the first of them cannot
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

  /// Reads the summary; of a file that has none, or one that says too little, the heads of its
  /// records, and the contents of chunks that have no index.
  /// Errors: Malformed, TooLarge, System.
  Result<Summary> summary();

  /// The last metadata of each name. Cost: a look at each record's head.
  /// Errors: Malformed, TooLarge, System.
  Result<std::map<std::string, Words>> metadata();

  /// Reads these channels alone: chunks without any are skipped where the whole index behind them
  /// says so.
  void select(std::set<std::uint16_t> channels) { selected_ = std::move(channels); }
  /// Skips messages of before; chunks without any other are not read.
  void start_at(std::uint64_t log_time);

  /// The next message by log time, in the order of the file where these are equal; nothing at the
  /// end. Schemas and channels that came before it are in `found`. Chunks whose times overlap are
  /// open at the same time; beyond the limit of a chunk's bytes the order is not kept.
  ///
  /// Errors: Truncated (the file has no end; everything before was read), Malformed, TooLarge,
  /// Unsupported, System. Read on after Malformed, TooLarge and Unsupported: at the next record.
  Result<std::optional<StoredMessage>> next();
  /// When that was logged. Errors: as next(), which does not give the same once more.
  Result<std::optional<std::uint64_t>> next_time();

  /// What next() has passed: schemas and channels.
  Summary found;

  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// How much of the file next() has read. [byte]
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  struct RecordPlace {
    Opcode opcode{};
    std::uint64_t content = 0, length = 0;  // where the content is
    [[nodiscard]] std::uint64_t end() const { return content + length; }
  };
  /// What is read at once: a chunk, or messages that are in none, one behind the other.
  struct Part {
    std::uint64_t first = 0, last = 0;  // log times
    std::uint64_t at = 0, end = 0;      // in the file
    bool is_chunk = false, has_index = false;
  };
  struct OpenPart {
    std::shared_ptr<const std::vector<std::byte>> bytes;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> messages;  // log times and places in it
    std::size_t next = 0;
    [[nodiscard]] std::uint64_t time() const { return messages[next].first; }
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
  /// Looks at the heads of all records, once; continues behind one that is damaged.
  Status scan();
  /// Takes what a record says of the file as a whole.
  Status scan_record(const RecordPlace& place, std::uint64_t at);
  /// Counts in `summary` what only the contents of chunks say.
  void count_contents(Summary& summary);
  /// Whether the indexes behind a chunk, up to the next record, say that nothing selected is in it.
  Result<bool> is_skipped(const Part& chunk);
  /// The messages of a part in their order; takes what it declares into `summary`.
  Result<OpenPart> open(const Part& part, Summary& summary);
  /// Lets go of parts that are read.
  void close_parts();
  /// The part that has the next message; null at the end. Errors: as next().
  Result<OpenPart*> front();

  std::string path_;
  internal::Descriptor descriptor_;
  std::uint64_t size_ = 0;
  ReaderLimits limits_;
  std::uint64_t kept_ = 0;  // of schemas and channels [byte]
  std::optional<std::set<std::uint16_t>> selected_;
  std::uint64_t start_ = 0;

  bool is_scanned_ = false;
  std::uint64_t scanned_ = kMagic.size();  // how much of the file is whole records [byte]
  Summary heads_;                          // what the heads of records say
  std::vector<Part> parts_;                // by time, once they are read
  std::vector<std::pair<std::string, RecordPlace>> metadata_;

  bool is_sorted_ = false;
  std::size_t next_part_ = 0;
  std::map<std::size_t, OpenPart> open_;  // by number of the part
  std::uint64_t open_bytes_ = 0, position_ = 0;
};

}  // namespace hc::mcap
