// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/chunk.h>

#include <algorithm>

namespace hc::mcap {
namespace {

Error damaged(const std::string& what) {
  return {Code::Malformed, "MCAP chunk: " + what};
}

}  // namespace

void ChunkBuilder::add(const MessageRecord& message,
                       std::span<const std::span<const std::byte>> data) {
  index_[message.channel].emplace_back(message.log_time, size());
  records_.begin(Opcode::Message, message.channel, message.sequence, message.log_time,
                 message.publish_time);
  for (const auto piece : data) records_.append(piece);
  records_.end();
}

Chunk ChunkBuilder::pack() const {
  const std::span<const std::byte> plain(records_.bytes);
  const auto smaller = compress_zstd(plain);
  const bool helps = !smaller.empty() && smaller.size() < plain.size();
  const auto stored = helps ? std::span(smaller) : plain;

  Chunk chunk;
  chunk.begin = index_.begin()->second.front().first;
  for (const auto& [channel, entries] : index_) {
    const auto [first, last] = std::ranges::minmax(entries);
    chunk.begin = std::min(chunk.begin, first.first);
    chunk.end = std::max(chunk.end, last.first);
  }
  chunk.messages = messages;
  chunk.plain = plain.size();
  chunk.compressed = stored.size();
  chunk.compression = helps ? "zstd" : "";
  RecordWriter out;
  out.bytes.reserve(stored.size() + 128 + 64 * index_.size());
  out.begin(Opcode::Chunk, chunk.begin, chunk.end, chunk.plain, crc32(plain), chunk.compression,
            chunk.compressed);
  out.append(stored);
  out.end();
  chunk.length = out.bytes.size();
  for (const auto& [channel, entries] : index_) {
    chunk.indexes[channel] = {out.bytes.size(), entries.size()};
    out.add(Opcode::MessageIndex, channel, entries);
  }
  chunk.bytes = std::move(out.bytes);
  return chunk;
}

Result<Bytes> unpack_chunk(const Bytes& content, std::uint64_t limit) {
  RecordReader reader(content.span);
  std::uint64_t plain_size = 0, stored_size = 0;
  std::uint32_t crc = 0;
  std::string compression;
  reader.take(16);  // first and last log time
  reader.get(plain_size, crc, compression, stored_size);
  Bytes bytes{reader.take(stored_size), content.owner};
  if (!reader.is_good()) return damaged("inconsistent lengths");
  if (plain_size > limit)
    return Error{Code::TooLarge, "MCAP chunk: " + std::to_string(plain_size) +
                                     " bytes, more than the limit of " + std::to_string(limit)};
  if (compression == "zstd") {
    auto expanded = expand_zstd(bytes.span, plain_size);
    if (!expanded) return expanded.error();
    const auto plain = std::make_shared<const std::vector<std::byte>>(std::move(*expanded));
    bytes = {*plain, plain};
  } else if (!compression.empty()) {
    return Error{Code::Unsupported,
                 "MCAP chunk: compression \"" + compression.substr(0, 20) +
                     "\" is not supported; convert it with `mcap compress --compression zstd`"};
  }
  if (bytes.span.size() != plain_size)
    return damaged(std::to_string(bytes.span.size()) + " bytes instead of " +
                   std::to_string(plain_size));
  if (crc != 0 && crc32(bytes.span) != crc) return damaged("wrong CRC");
  return bytes;
}

}  // namespace hc::mcap
