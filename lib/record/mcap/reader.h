// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads MCAP files, also of other programs: the summary, and messages by log time. If a file was
// truncated by a crash, its complete chunks are read. Memory is bounded by the limits and the
// number of chunks, whatever the file contains.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <record/mcap/chunk.h>
#include <record/mcap/input_file.h>

namespace hc::mcap {

struct ReaderLimits {
  std::uint64_t chunk_bytes = std::uint64_t{512} << 20;   ///< of a chunk or message, uncompressed
  std::uint64_t summary_bytes = std::uint64_t{64} << 20;  ///< of all schemas and channels
};

struct Summary {
  std::string profile;  ///< "ros2"; empty: none
  std::map<std::uint16_t, SchemaRecord> schemas;
  std::map<std::uint16_t, ChannelRecord> channels;
  std::map<std::uint16_t, std::uint64_t> counts;  ///< of messages, by channel
  std::uint64_t begin = 0, end = 0;               ///< log times [ns since the Unix epoch]
  std::uint64_t chunks = 0;                       ///< number of them
  std::uint64_t plain = 0;                        ///< their size, uncompressed [byte]
  std::vector<std::string> metadata;              ///< the name of each record
  bool is_whole = false;                          ///< not truncated
  std::uint64_t unread = 0;  ///< chunks without index that cannot be read; not in `counts`
  std::string why_unread;    ///< the first error about them
};

/// A message, in the memory of its chunk.
struct StoredMessage {
  MessageRecord record;
  const ChannelRecord* channel = nullptr;  ///< owned by the reader
  const SchemaRecord* schema = nullptr;    ///< null: none
  std::span<const std::byte> data;
  std::shared_ptr<const void> owner;
  std::size_t owned = 0;  ///< size of the owner [byte]
};

class Reader {
 public:
  /// Opens a file and reads its summary. If that does not list all records, scans the file for them
  /// and decompresses chunks without an index.
  ///
  /// Errors: NotFound, System; Malformed (not MCAP, or a damaged summary), TooLarge, Unsupported
  /// (a pipe or device).
  static Result<Reader> open(const std::string& path, const ReaderLimits& limits = {});

  /// Grows while chunks are read, by schemas and channels that are declared only in them.
  [[nodiscard]] const Summary& summary() const { return summary_; }
  /// All metadata, in file order. Errors: Malformed, TooLarge, System.
  Result<std::vector<MetadataRecord>> metadata();

  /// Reads only these channels; chunks without them are skipped if their index is complete.
  void select(std::set<std::uint16_t> channels) { selected_ = std::move(channels); }
  [[nodiscard]] bool is_selected(std::uint16_t channel) const {
    return !selected_ || selected_->contains(channel);
  }
  /// Skips messages before this time, and chunks that contain only such messages.
  void start_at(std::uint64_t log_time);

  /// The next message by log time, messages of equal time in file order; nullopt at the end. Chunks
  /// that overlap in time are held open together, up to the limit of a chunk's bytes; beyond it
  /// their messages are not sorted.
  ///
  /// Errors: Truncated (once, at the end of a truncated file), Malformed, TooLarge, Unsupported,
  /// System. After Malformed, TooLarge and Unsupported the next call continues with the next chunk.
  Result<std::optional<StoredMessage>> next();
  /// The log time of the next message. Errors: as next(), each of them once.
  Result<std::optional<std::uint64_t>> next_time();

  [[nodiscard]] int descriptor() const { return file_.descriptor(); }
  [[nodiscard]] std::uint64_t size() const { return file_.size(); }
  /// The part of the file that next() has read. [byte]
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  /// The unit of reading: a chunk, or a run of messages outside of chunks.
  struct Part {
    std::uint64_t first = 0, last = 0;  // log times
    std::uint64_t at = 0, end = 0;      // offsets in the file
    std::uint64_t indexed = 0;          // end of a chunk's MessageIndex records, from the summary
    std::uint64_t plain = 0;            // size of a chunk's messages [byte]
    bool is_chunk = false;
    bool is_counted = false;  // its messages are in Summary::counts
  };
  struct OpenPart {
    Bytes bytes;
    std::size_t left = 0;  // messages to be read
  };
  struct Pending {
    std::uint64_t time = 0, at = 0;  // in the part's bytes
    std::shared_ptr<OpenPart> part;
  };

  Reader(InputFile file, const ReaderLimits& limits) : file_(std::move(file)), limits_(limits) {}

  /// Adds a schema or channel to the summary. Errors: Malformed, TooLarge.
  Status declare(const RecordPlace& place, std::span<const std::byte> content);
  /// Reads the summary section, if there is one. Returns the chunks that it indexes, or none if it
  /// lacks the message counts.
  Result<std::vector<Part>> read_summary();
  /// Reads the heads of all records except these chunks and their indexes.
  Status scan(const std::vector<Part>& chunks);
  Status scan_record(const RecordPlace& place, bool is_counted);
  void add_chunk(const Part& chunk);
  void add_times(const Part& part);
  /// Reads chunks whose messages have not been counted or whose channels are not declared.
  void count_contents();
  /// Whether a part has no selected messages, by its times and indexes.
  Result<bool> is_skipped(const Part& part);
  /// Reads a part: its wanted messages in file order, and declarations.
  Result<std::vector<Pending>> open(const Part& part,
                                    const std::function<bool(const MessageRecord&)>& is_wanted);
  /// Makes pending_[next_] the next message; false at the end. Errors: as next().
  Result<bool> fill();
  void pop();

  InputFile file_;
  ReaderLimits limits_;
  std::uint64_t declared_ = 0;  // schemas and channels [byte]
  Summary summary_;
  std::vector<RecordPlace> metadata_;
  std::uint64_t scanned_ = kMagic.size();  // end of the last complete record [byte]
  std::vector<Part> parts_;                // by time
  std::optional<std::set<std::uint16_t>> selected_;
  std::uint64_t start_ = 0;

  std::size_t next_part_ = 0;
  std::vector<Pending> pending_;  // messages of open parts, by time
  std::size_t next_ = 0;
  std::uint64_t open_bytes_ = 0, position_ = 0;
  bool is_truncation_reported_ = false;
};

}  // namespace hc::mcap
