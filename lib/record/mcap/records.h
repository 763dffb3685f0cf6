// SPDX-License-Identifier: Apache-2.0
#pragma once
// The records of MCAP files: encoding and decoding of numbers, strings, maps and lists.
// Pure. Source: https://mcap.dev/spec

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace hc::mcap {

/// The first and last bytes of a file.
inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
/// The head of each record: opcode and length. [byte]
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

using StringMap = std::map<std::string, std::string>;

struct SchemaRecord {
  std::uint16_t id = 0;  ///< 0: no schema
  std::string name, encoding, text;
};

struct ChannelRecord {
  std::uint16_t id = 0, schema = 0;
  std::string topic, encoding;
  StringMap metadata;
};

/// The head of a message, followed by its data.
struct MessageRecord {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;  ///< [ns since the Unix epoch]
};

struct MetadataRecord {
  std::string name;
  StringMap words;
};

class RecordWriter {
 public:
  std::vector<std::byte> bytes;

  void add(Opcode opcode, const auto&... fields) {
    begin(opcode);
    (put(fields), ...);
    end();
  }
  /// Begins a record whose fields do not fit into one add(); end() sets its length.
  void begin(Opcode opcode, const auto&... fields) {
    (put(opcode), put(std::uint64_t{0}));
    begin_ = bytes.size();
    (put(fields), ...);
  }
  void end() { set(begin_ - sizeof(std::uint64_t), std::uint64_t{bytes.size() - begin_}); }

  void append(std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  void set(std::size_t at, auto number) { std::memcpy(&bytes[at], &number, sizeof number); }

 private:
  template <typename T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void put(T value) { append(std::as_bytes(std::span(&value, 1))); }
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    append(std::as_bytes(std::span(text)));
  }
  /// A map, or a list of pairs.
  template <typename Pairs>
  requires std::is_class_v<typename Pairs::value_type>
  void put(const Pairs& pairs) {
    put(std::uint32_t{0});
    const std::size_t begin = bytes.size();
    for (const auto& [first, second] : pairs) (put(first), put(second));
    set(begin - sizeof(std::uint32_t), static_cast<std::uint32_t>(bytes.size() - begin));
  }

  std::size_t begin_ = 0;
};

/// Reads the content of a record. Missing fields read as 0 or empty and make is_good() false.
class RecordReader {
 public:
  explicit RecordReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] bool at_end() const { return bytes_.empty() || !is_good_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

  void get(auto&... fields) { (get_one(fields), ...); }
  std::span<const std::byte> take(std::uint64_t size) {
    is_good_ = is_good_ && size <= bytes_.size();
    if (!is_good_) return {};
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

 private:
  template <typename T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void get_one(T& value) {
    const auto taken = take(sizeof value);
    if (is_good_) std::memcpy(&value, taken.data(), sizeof value);
  }
  void get_one(std::string& text) {
    const auto taken = take_list();
    text.assign(reinterpret_cast<const char*>(taken.data()), taken.size());
  }
  template <typename Key, typename Value>
  void get_one(std::map<Key, Value>& map) {
    for (RecordReader entries(take_list()); !entries.at_end();) {
      Key key{};
      entries.get(key);
      entries.get(map[std::move(key)]);
      is_good_ = is_good_ && entries.is_good();
    }
  }
  std::span<const std::byte> take_list() {
    std::uint32_t size = 0;
    get(size);
    return take(size);
  }

  std::span<const std::byte> bytes_;
  bool is_good_ = true;
};

/// CRC-32 as in zlib; `crc` is that of the preceding bytes. Cost: about 2 GB/s.
std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t crc = 0);

}  // namespace hc::mcap
