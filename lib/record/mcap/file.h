// SPDX-License-Identifier: Apache-2.0
#pragma once
// An MCAP file that is being written: chunks come whole, and the summary at the end. What is in the
// file when its writer is killed can be read, up to the last whole chunk.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>
#include <record/mcap/chunk.h>

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

/// Metadata of channels: the stream of one for messages of MTP; and beside which one another is.
inline constexpr const char *kStreamKey = "hypercolumn.stream", *kBesideKey = "hypercolumn.mtp";

struct MetadataRecord {
  std::string name;
  Words words;
};

class File {
 public:
  /// Begins a file, as begin_file() does: beside one that has contents. Errors: as that.
  static Result<File> create(const std::string& path);

  // Errors of all: System. The file is what it was before then, and can be closed.

  Status add(const SchemaRecord& schema);
  Status add(const ChannelRecord& channel);
  Status add(const MetadataRecord& metadata);
  Status add(const PackedChunk& chunk);

  /// Writes the summary, for which there is room: each record is refused that would take it.
  Status close();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }

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
  File(std::string path, internal::Descriptor descriptor)
      : path_(std::move(path)), descriptor_(std::move(descriptor)) {}
  Status write(std::span<const std::byte> bytes);
  [[nodiscard]] Status reserve(std::uint64_t bytes) const;
  /// Writes behind what is there, and leaves room for the summary.
  Status append(std::span<const std::byte> bytes);
  /// Writes a record that the summary repeats, and notes it.
  template <typename T>
  Status add_record(const T& record, std::vector<Placed<T>>& placed);
  [[nodiscard]] std::vector<std::byte> summary() const;

  std::string path_;
  internal::Descriptor descriptor_;
  std::uint64_t size_ = 0, repeated_ = 0;  // the latter of records that the summary repeats [byte]
  std::vector<Placed<SchemaRecord>> schemas_;
  std::vector<Placed<ChannelRecord>> channels_;
  std::vector<Placed<MetadataPlace>> metadata_;
  std::uint32_t chunks_ = 0;
  std::uint64_t first_ = 0, last_ = 0;             // log times in them [ns]
  RecordWriter chunk_index_;                       // of all chunks, as the summary has it
  std::map<std::uint16_t, std::uint64_t> counts_;  // of messages, by channel
};

}  // namespace hc::mcap
