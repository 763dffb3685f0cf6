// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes an MCAP file: complete chunks, then the summary. If the program is killed, all chunks
// written so far are readable.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>
#include <record/mcap/chunk.h>

namespace hc::mcap {

class File {
 public:
  /// Creates a file like begin_file(), never over an existing one. Errors: those of begin_file().
  static Result<File> create(const std::string& path, std::string_view profile = "ros2");

  // Errors of all: System. The file is then unchanged and can be closed.

  Status add(const SchemaRecord& schema);
  Status add(const ChannelRecord& channel);
  Status add(const MetadataRecord& metadata);
  Status add(const Chunk& chunk);

  /// Writes the summary. Succeeds on a full disk, since each record reserves space for it.
  Status close();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  /// Records of one kind for the summary.
  struct Group {
    RecordWriter records;
    std::uint32_t count = 0;
  };

  File(std::string path, Descriptor descriptor)
      : path_(std::move(path)), descriptor_(std::move(descriptor)) {}
  Status write(std::span<const std::byte> bytes);
  [[nodiscard]] Status reserve(std::uint64_t bytes) const;
  /// Writes records, and adds an entry about them to the summary.
  Status append(std::span<const std::byte> records, Opcode opcode,
                std::span<const std::byte> in_summary);
  [[nodiscard]] std::vector<std::byte> summary();

  std::string path_;
  Descriptor descriptor_;
  std::uint64_t size_ = 0;
  std::map<Opcode, Group> summary_;
  std::uint64_t begin_ = 0, end_ = 0;              // first and last log time [ns]
  std::map<std::uint16_t, std::uint64_t> counts_;  // of messages, by channel
};

}  // namespace hc::mcap
