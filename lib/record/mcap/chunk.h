// SPDX-License-Identifier: Apache-2.0
#pragma once
// Chunks: messages that a file contains compressed together. Pure.

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

/// Bytes, and what keeps them in memory.
struct Bytes {
  std::span<const std::byte> span;
  std::shared_ptr<const void> owner;
};

/// A chunk as it is written to a file: its record, followed by its MessageIndex records.
struct Chunk {
  struct Index {
    std::uint64_t offset = 0;  ///< of the MessageIndex record in `bytes`
    std::uint64_t count = 0;   ///< of messages
  };
  std::vector<std::byte> bytes;
  std::uint64_t length = 0;                 ///< of the chunk's record [byte]
  std::uint64_t begin = 0, end = 0;         ///< first and last log time
  std::uint64_t compressed = 0, plain = 0;  ///< size of its messages [byte]
  std::string_view compression;             ///< "zstd", or empty
  std::map<std::uint16_t, Index> indexes;   ///< by channel
};

/// Collects messages for a chunk.
class ChunkBuilder {
 public:
  /// Messages of MTP, each of which is one or more messages of MCAP; counted by the caller.
  std::uint64_t messages = 0;

  /// Adds a message whose data are these pieces.
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
/// @param content  of its record.
/// @param limit  of their size. [byte]
///
/// Errors: Malformed (lengths, zstd or CRC are wrong), TooLarge, Unsupported (another compression).
Result<Bytes> unpack_chunk(const Bytes& content, std::uint64_t limit);

// In chunk_zstd.cpp, or in no_chunk_zstd.cpp if libzstd is missing. Unlike hc::expand() they bound
// the memory for a chunk only by its limit: blank images of 64 MB and more have to be read again.

/// The bytes compressed; empty if this build lacks the library.
std::vector<std::byte> compress_zstd(std::span<const std::byte> plain);

/// Errors: Malformed; Unsupported (this build lacks the library).
/// Cost: allocates `size` bytes, but not if `bytes` are too few to expand to that many.
Result<std::vector<std::byte>> expand_zstd(std::span<const std::byte> bytes, std::uint64_t size);

}  // namespace hc::mcap
