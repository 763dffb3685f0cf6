// SPDX-License-Identifier: Apache-2.0
#pragma once
// The records that an MCAP file is made of: numbers, strings and maps to bytes and back. Pure.
// Source: https://mcap.dev/spec

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace hc::mcap {

/// What begins and ends a file.
inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
/// Before the content of each record: its opcode and length. [byte]
inline constexpr std::size_t kRecordHead = 9;

enum class Opcode : std::uint8_t {
  Header = 1,
  Footer,
  Schema,
  Channel,
  Message,
  Chunk,
  MessageIndex,
  ChunkIndex,
  Attachment,
  AttachmentIndex,
  Statistics,
  Metadata,
  MetadataIndex,
  SummaryOffset,
  DataEnd,
};

using Words = std::map<std::string, std::string>;

/// Writes records, one after the other.
class RecordWriter {
 public:
  std::vector<std::byte> bytes;

  /// Begins a record; end() gives it its length.
  void begin(Opcode opcode) {
    number(static_cast<std::uint8_t>(opcode));
    begin_ = bytes.size();
    number(std::uint64_t{0});
  }
  void end() {
    const std::uint64_t length = bytes.size() - begin_ - sizeof(length);
    std::memcpy(bytes.data() + begin_, &length, sizeof length);
  }

  template <typename T>
  void number(T value) {
    static_assert(std::is_integral_v<T>);
    append(std::as_bytes(std::span(&value, 1)));
  }
  void string(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    append(std::as_bytes(std::span(text)));
  }
  void words(const Words& map) {
    std::size_t size = 0;
    for (const auto& [key, value] : map) size += 8 + key.size() + value.size();
    number(static_cast<std::uint32_t>(size));
    for (const auto& [key, value] : map) {
      string(key);
      string(value);
    }
  }
  void append(std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  }

 private:
  std::size_t begin_ = 0;
};

/// Reads the content of a record. What is missing reads as 0 or empty, and is_good() is false then.
class RecordReader {
 public:
  explicit RecordReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] bool at_end() const { return bytes_.empty() || !is_good_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

  template <typename T>
  T number() {
    T value{};
    const auto taken = take(sizeof value);
    if (is_good_) std::memcpy(&value, taken.data(), sizeof value);
    return value;
  }
  std::string_view string() {
    const auto taken = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }
  /// The content of an array or map, whose length in bytes precedes it.
  RecordReader list() { return RecordReader(take(number<std::uint32_t>())); }
  Words words() {
    Words map;
    for (auto entries = list(); !entries.at_end();) {
      const auto key = entries.string();
      map[std::string(key)] = entries.string();
      is_good_ = is_good_ && entries.is_good();
    }
    return map;
  }
  std::span<const std::byte> take(std::uint64_t size) {
    is_good_ = is_good_ && size <= bytes_.size();
    if (!is_good_) return {};
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

 private:
  std::span<const std::byte> bytes_;
  bool is_good_ = true;
};

/// CRC-32 as of zlib, of bytes that follow those of which `crc` is. Cost: about 2 GB/s.
std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t crc = 0);

}  // namespace hc::mcap
