// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/chunk.h>

#include <algorithm>

#include <record/mcap/chunk_codec.h>

namespace hc::mcap {
namespace {

Error damaged(const std::string& what) {
  return {Code::Malformed, "MCAP chunk: " + what};
}

}  // namespace

void ChunkBuilder::add(const MessageRecord& message,
                       std::span<const std::span<const std::byte>> data) {
  index_[message.channel].emplace_back(message.log_time, size());
  begin_ = std::min(begin_, message.log_time);
  end_ = std::max(end_, message.log_time);
  records_.begin(Opcode::Message);
  records_.number(message.channel);
  records_.number(message.sequence);
  records_.number(message.log_time);
  records_.number(message.publish_time);
  for (const auto piece : data) records_.append(piece);
  records_.end();
}

ChunkPacker::ChunkPacker(int level) : compressor_(internal::make_compressor(level)) {}

ChunkPacker::~ChunkPacker() = default;

PackedChunk ChunkPacker::pack(const ChunkBuilder& chunk) {
  const std::span<const std::byte> plain(chunk.records_.bytes);
  // What does not get smaller stays as it is.
  const auto smaller = compressor_ != nullptr ? compressor_->compress(plain) : plain;
  const bool helps = smaller.size() < plain.size();
  const auto stored = helps ? smaller : plain;

  RecordWriter out;
  out.bytes.reserve(stored.size() + 128 + 64 * chunk.index_.size());
  ChunkInfo info{chunk.begin_, chunk.end_,          0,  0, 0, stored.size(),
                 plain.size(), helps ? "zstd" : "", {}, {}};
  out.begin(Opcode::Chunk);
  out.number(info.begin);
  out.number(info.end);
  out.number(info.plain);
  out.number(crc32(plain));
  out.string(info.compression);
  out.number(info.compressed);
  out.append(stored);
  out.end();
  info.length = out.bytes.size();
  for (const auto& [channel, entries] : chunk.index_) {
    info.index_offsets[channel] = out.bytes.size();
    info.counts[channel] = entries.size();
    out.begin(Opcode::MessageIndex);
    out.number(channel);
    out.number(static_cast<std::uint32_t>(entries.size() * 16));
    for (const auto& [time, offset] : entries) {
      out.number(time);
      out.number(offset);
    }
    out.end();
  }
  info.index_length = out.bytes.size() - info.length;
  return {std::move(out.bytes), std::move(info), chunk.messages};
}

Result<std::vector<std::byte>> unpack_chunk(std::span<const std::byte> content,
                                            std::uint64_t limit) {
  RecordReader reader(content);
  reader.take(16);
  const auto plain_size = reader.number<std::uint64_t>();
  const auto crc = reader.number<std::uint32_t>();
  const auto compression = reader.string();
  const auto stored = reader.take(reader.number<std::uint64_t>());
  if (!reader.is_good()) return damaged("its lengths do not add up");
  if (plain_size > limit)
    return Error{Code::TooLarge, "MCAP chunk: it holds " + std::to_string(plain_size) +
                                     " bytes, more than the limit of " + std::to_string(limit)};
  std::vector<std::byte> plain;
  if (compression.empty()) {
    plain.assign(stored.begin(), stored.end());
  } else if (compression == "zstd") {
    auto expanded = internal::expand_zstd(stored, plain_size);
    if (!expanded) return expanded.error();
    plain = std::move(*expanded);
  } else {
    return Error{Code::Unsupported,
                 "MCAP chunk: compression \"" + std::string(compression.substr(0, 20)) +
                     "\" is not known here; `mcap compress --compression zstd` changes it"};
  }
  if (plain.size() != plain_size)
    return damaged("it holds " + std::to_string(plain.size()) + " bytes, and says " +
                   std::to_string(plain_size));
  if (crc != 0 && crc32(plain) != crc) return damaged("its CRC is wrong");
  return plain;
}

}  // namespace hc::mcap
