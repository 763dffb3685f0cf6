// SPDX-License-Identifier: Apache-2.0
#pragma once
// An MCAP file that is read at any place.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>
#include <record/mcap/records.h>

namespace hc::mcap {

/// Where a record is in a file.
struct RecordPlace {
  Opcode opcode{};
  std::uint64_t at = 0, length = 0;  // offset of the record, size of its content
  [[nodiscard]] std::uint64_t content() const { return at + kRecordHead; }
  [[nodiscard]] std::uint64_t end() const { return content() + length; }
};

class InputFile {
 public:
  /// Errors: NotFound, System; Malformed (not MCAP), Unsupported (a pipe or device).
  static Result<InputFile> open(const std::string& path);

  /// So many bytes at an offset. Errors: TooLarge (more than the limit), Truncated, System.
  Result<std::vector<std::byte>> read(std::uint64_t at, std::uint64_t size,
                                      std::uint64_t limit) const;
  /// The record at an offset. Errors: Truncated, System.
  [[nodiscard]] Result<RecordPlace> record_at(std::uint64_t at) const;
  /// The error of a file of which only the bytes before an offset are complete.
  [[nodiscard]] Error truncated(std::uint64_t at) const;

  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] std::uint64_t size() const { return size_; }

 private:
  InputFile(std::string path, Descriptor descriptor, std::uint64_t size)
      : path_(std::move(path)), descriptor_(std::move(descriptor)), size_(size) {}

  std::string path_;
  Descriptor descriptor_;
  std::uint64_t size_ = 0;
};

}  // namespace hc::mcap
