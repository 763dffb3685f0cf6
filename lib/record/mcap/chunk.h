// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages gathered into a chunk, which a file holds compressed; and out of it again. Pure.

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <record/mcap/records.h>

namespace hc::internal {
class Compressor;
}

namespace hc::mcap {

/// A message of a file.
struct MessageRecord {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;      ///< [ns since the Unix epoch]
  std::uint64_t publish_time = 0;  ///< [ns since the Unix epoch]
};

/// Messages that are not in a file yet.
class ChunkBuilder {
 public:
  /// Messages of MTP in it, each of which is one or more of the file's; whoever adds them counts.
  std::uint64_t messages = 0;

  /// Adds a message; its data in pieces.
  void add(const MessageRecord& message, std::span<const std::span<const std::byte>> data);

  [[nodiscard]] std::size_t size() const { return records_.bytes.size(); }
  [[nodiscard]] bool empty() const { return index_.empty(); }
  [[nodiscard]] std::uint64_t begin() const { return begin_; }

 private:
  friend class ChunkPacker;
  RecordWriter records_;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;
  std::uint64_t begin_ = std::numeric_limits<std::uint64_t>::max(), end_ = 0;
};

/// What a summary says of a chunk.
struct ChunkInfo {
  std::uint64_t begin = 0, end = 0;         ///< log times of its messages
  std::uint64_t offset = 0;                 ///< of its record in the file
  std::uint64_t length = 0;                 ///< of its record
  std::uint64_t index_length = 0;           ///< of the records of MessageIndex behind it
  std::uint64_t compressed = 0, plain = 0;  ///< bytes of its messages
  std::string compression;                  ///< "zstd", or empty
  std::map<std::uint16_t, std::uint64_t> index_offsets;  ///< by channel, of MessageIndex
  std::map<std::uint16_t, std::uint64_t> counts;         ///< of messages, where it is known
};

/// A chunk as it is in a file, with its MessageIndex behind it; offsets count from its begin.
struct PackedChunk {
  std::vector<std::byte> bytes;
  ChunkInfo info;
  std::uint64_t messages = 0;  ///< as ChunkBuilder has it
};

/// Compresses chunks, one after the other.
class ChunkPacker {
 public:
  /// @param level  of zstd: 1 (fast) … 19 (small).
  explicit ChunkPacker(int level);
  ~ChunkPacker();
  ChunkPacker(const ChunkPacker&) = delete;
  ChunkPacker& operator=(const ChunkPacker&) = delete;

  PackedChunk pack(const ChunkBuilder& chunk);

 private:
  std::unique_ptr<internal::Compressor> compressor_;  // null: this build has none
};

/// The messages of a chunk's record, plain.
///
/// @param content  of the record.
/// @param limit  most bytes that it may hold. [byte]
///
/// Errors: Malformed (damaged: lengths, zstd, CRC), TooLarge, Unsupported (another compression).
/// Cost: no memory for what the bytes cannot hold.
Result<std::vector<std::byte>> unpack_chunk(std::span<const std::byte> content,
                                            std::uint64_t limit);

}  // namespace hc::mcap
