// SPDX-License-Identifier: Apache-2.0
#pragma once
// An MCAP file that is being written: chunks come whole, and the summary at the end. What is in the
// file when its writer is killed can be read, up to the last whole chunk.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>
#include <mcap/chunk.h>

namespace hc::mcap {

struct SchemaRecord {
  std::uint16_t id = 0;  ///< 0: no schema
  std::string name, encoding, text;
};

struct ChannelRecord {
  std::uint16_t id = 0, schema = 0;
  std::string topic, encoding;
  Words metadata;
};

struct MetadataRecord {
  std::string name;
  Words words;
};

class File {
 public:
  /// Creates a file. Errors: System.
  /// @param replaces  an existing file is replaced; without, it is an error.
  static Result<File> create(const std::string& path, bool replaces);

  // Errors of all: System. The file is what it was before then, and can be closed.

  Status add(const SchemaRecord& schema);
  Status add(const ChannelRecord& channel);
  Status add(const MetadataRecord& metadata);
  Status add(const PackedChunk& chunk);

  /// Writes the summary. Where the disk has no room for it, the last chunks make room.
  Status close();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Messages (PackedChunk::messages) that close() has taken out again.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  /// What the summary repeats, and where it is.
  template <typename T>
  struct Placed {
    T record;
    std::uint64_t offset = 0;
  };
  struct MetadataPlace {
    std::string name;
    std::uint64_t length = 0;
  };
  /// A chunk of the file, and where what the summary says of it begins.
  struct ChunkPlace {
    std::uint64_t offset = 0, begin = 0, end = 0, messages = 0;
    std::size_t index = 0, counts = 0;
  };

  File(std::string path, internal::Descriptor descriptor)
      : path_(std::move(path)), descriptor_(std::move(descriptor)) {}
  Status write(std::span<const std::byte> bytes);
  /// Writes a record that the summary repeats, and notes it.
  template <typename T>
  Status add_record(const T& record, std::vector<Placed<T>>& placed);
  [[nodiscard]] std::vector<std::byte> summary() const;

  std::string path_;
  internal::Descriptor descriptor_;
  std::uint64_t size_ = 0, lost_ = 0;
  std::vector<Placed<SchemaRecord>> schemas_;
  std::vector<Placed<ChannelRecord>> channels_;
  std::vector<Placed<MetadataPlace>> metadata_;
  std::vector<ChunkPlace> chunks_;
  RecordWriter chunk_index_;  // of all chunks, as the summary has it
  std::vector<std::pair<std::uint16_t, std::uint64_t>> counts_;  // by channel, chunk after chunk
};

}  // namespace hc::mcap
