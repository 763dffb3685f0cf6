// SPDX-License-Identifier: Apache-2.0
#pragma once
// Chunks: groups of messages that are compressed together. Pure.

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <record/mcap/records.h>

namespace hc::mcap {

struct Bytes {
  std::span<const std::byte> span;
  std::shared_ptr<const void> owner;
};

/// A chunk as written to a file: its record, followed by its MessageIndex records.
struct Chunk {
  struct Index {
    std::uint64_t offset = 0;  ///< of the MessageIndex record in `bytes`
    std::uint64_t count = 0;   ///< of messages
  };
  std::vector<std::byte> bytes;
  std::uint64_t length = 0;                 ///< of the chunk's record [byte]
  std::uint64_t begin = 0, end = 0;         ///< first and last log time
  std::uint64_t compressed = 0, plain = 0;  ///< size of the messages [byte]
  std::uint64_t messages = 0;               ///< as ChunkBuilder::messages
  std::string_view compression;             ///< "zstd", or empty
  std::map<std::uint16_t, Index> indexes;   ///< by channel
};

class ChunkBuilder {
 public:
  /// Messages of MTP, each stored as one or more messages of MCAP; counted by the caller.
  std::uint64_t messages = 0;

  /// Adds a message whose data is split into pieces.
  void add(const MessageRecord& message, std::span<const std::span<const std::byte>> data);

  [[nodiscard]] std::size_t size() const { return records_.bytes.size(); }
  [[nodiscard]] bool empty() const { return index_.empty(); }

  /// The chunk, compressed if that makes it smaller.
  [[nodiscard]] Chunk pack() const;

 private:
  RecordWriter records_;
  // Log time and offset of each message, by channel.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;
};

/// Decompresses the messages of a chunk.
///
/// @param content  of the chunk's record.
/// @param limit  on the uncompressed size. [byte]
///
/// Errors: Malformed (lengths, zstd or CRC are wrong), TooLarge, Unsupported (another compression).
Result<Bytes> unpack_chunk(const Bytes& content, std::uint64_t limit);

// In chunk_zstd.cpp, or in no_chunk_zstd.cpp if libzstd is missing. Unlike hc::expand(), these
// limit only the absolute size: recorded blank images of 64 MB and more must remain readable.

/// Compresses bytes; empty if this build lacks the library.
std::vector<std::byte> compress_zstd(std::span<const std::byte> plain);

/// Errors: Malformed; Unsupported (this build lacks the library).
/// Cost: allocates `size` bytes, unless `bytes` cannot expand to that many.
Result<std::vector<std::byte>> expand_zstd(std::span<const std::byte> bytes, std::uint64_t size);

}  // namespace hc::mcap
