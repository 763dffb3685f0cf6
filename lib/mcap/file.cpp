// SPDX-License-Identifier: Apache-2.0
#include <mcap/file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace hc::mcap {
namespace {

void write_record(RecordWriter& out, const SchemaRecord& schema) {
  out.begin(Opcode::Schema);
  out.number(schema.id);
  out.string(schema.name);
  out.string(schema.encoding);
  out.string(schema.text);
  out.end();
}

void write_record(RecordWriter& out, const ChannelRecord& channel) {
  out.begin(Opcode::Channel);
  out.number(channel.id);
  out.number(channel.schema);
  out.string(channel.topic);
  out.string(channel.encoding);
  out.words(channel.metadata);
  out.end();
}

void write_map(RecordWriter& out, const std::map<std::uint16_t, std::uint64_t>& map) {
  constexpr std::size_t kEntry = 10;
  out.number(static_cast<std::uint32_t>(map.size() * kEntry));
  for (const auto& [channel, number] : map) {
    out.number(channel);
    out.number(number);
  }
}

void write_chunk_index(RecordWriter& out, const ChunkInfo& chunk) {
  out.begin(Opcode::ChunkIndex);
  out.number(chunk.begin);
  out.number(chunk.end);
  out.number(chunk.offset);
  out.number(chunk.length);
  write_map(out, chunk.index_offsets);
  out.number(chunk.index_length);
  out.string(chunk.compression);
  out.number(chunk.compressed);
  out.number(chunk.plain);
  out.end();
}

}  // namespace

Result<File> File::create(const std::string& path, bool replaces) {
  constexpr mode_t kMode = 0666;
  internal::Descriptor descriptor(
      ::open(path.c_str(), O_WRONLY | O_CREAT | (replaces ? O_TRUNC : O_EXCL) | O_CLOEXEC, kMode));
  if (!descriptor) return internal::system_error("open", path);
  File file(path, std::move(descriptor));
  constexpr std::size_t kHeader = 64;
  RecordWriter out;
  out.bytes.reserve(kHeader);
  out.append(std::as_bytes(std::span(kMagic)));
  out.begin(Opcode::Header);
  out.string("ros2");
  out.string("hypercolumn 0.1");
  out.end();
  if (auto written = file.write(out.bytes); !written) return written.error();
  return file;
}

Status File::write(std::span<const std::byte> bytes) {
  const std::uint64_t begin = size_;
  while (!bytes.empty()) {
    const ssize_t size =
        ::pwrite(descriptor_.get(), bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) {
      auto error = internal::system_error("write", path_);
      size_ = begin;
      static_cast<void>(::ftruncate(descriptor_.get(), static_cast<off_t>(begin)));
      return error;
    }
    size_ += static_cast<std::uint64_t>(size);
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return {};
}

template <typename T>
Status File::add_record(const T& record, std::vector<Placed<T>>& placed) {
  RecordWriter out;
  write_record(out, record);
  const std::uint64_t offset = size_;
  auto written = write(out.bytes);
  if (written) placed.push_back({record, offset});
  return written;
}

Status File::add(const SchemaRecord& schema) {
  return add_record(schema, schemas_);
}

Status File::add(const ChannelRecord& channel) {
  return add_record(channel, channels_);
}

Status File::add(const MetadataRecord& metadata) {
  RecordWriter out;
  out.begin(Opcode::Metadata);
  out.string(metadata.name);
  out.words(metadata.words);
  out.end();
  const Placed<MetadataPlace> place{{metadata.name, out.bytes.size()}, size_};
  auto written = write(out.bytes);
  if (written) metadata_.push_back(place);
  return written;
}

Status File::add(const PackedChunk& chunk) {
  ChunkInfo info = chunk.info;
  info.offset = size_;
  for (auto& [channel, offset] : info.index_offsets) offset += size_;
  if (auto written = write(chunk.bytes); !written) return written;
  chunks_.push_back({info.offset, info.begin, info.end, chunk.messages, chunk_index_.bytes.size(),
                     counts_.size()});
  write_chunk_index(chunk_index_, info);
  counts_.insert(counts_.end(), info.counts.begin(), info.counts.end());
  return {};
}

std::vector<std::byte> File::summary() const {
  RecordWriter out;
  out.begin(Opcode::DataEnd);
  out.number(std::uint32_t{0});
  out.end();
  const std::uint64_t data_end = out.bytes.size(), begin = size_ + data_end;

  struct Group {
    Opcode opcode;
    std::uint64_t begin, length;
  };
  std::vector<Group> groups;
  auto end_group = [&](Opcode opcode) {
    const std::uint64_t at = groups.empty() ? begin : groups.back().begin + groups.back().length;
    if (size_ + out.bytes.size() > at)
      groups.push_back({opcode, at, size_ + out.bytes.size() - at});
  };
  for (const auto& schema : schemas_) write_record(out, schema.record);
  end_group(Opcode::Schema);
  for (const auto& channel : channels_) write_record(out, channel.record);
  end_group(Opcode::Channel);

  std::map<std::uint16_t, std::uint64_t> counts;
  std::uint64_t messages = 0, first = 0, last = 0;
  for (const auto& chunk : chunks_) {
    first = &chunk == chunks_.data() ? chunk.begin : std::min(first, chunk.begin);
    last = std::max(last, chunk.end);
  }
  for (const auto& [channel, count] : counts_) {
    counts[channel] += count;
    messages += count;
  }
  out.begin(Opcode::Statistics);
  out.number(messages);
  out.number(static_cast<std::uint16_t>(schemas_.size()));
  out.number(static_cast<std::uint32_t>(channels_.size()));
  out.number(std::uint32_t{0});
  out.number(static_cast<std::uint32_t>(metadata_.size()));
  out.number(static_cast<std::uint32_t>(chunks_.size()));
  out.number(first);
  out.number(last);
  write_map(out, counts);
  out.end();
  end_group(Opcode::Statistics);
  out.append(chunk_index_.bytes);
  end_group(Opcode::ChunkIndex);
  for (const auto& [metadata, offset] : metadata_) {
    out.begin(Opcode::MetadataIndex);
    out.number(offset);
    out.number(metadata.length);
    out.string(metadata.name);
    out.end();
  }
  end_group(Opcode::MetadataIndex);

  const std::uint64_t offsets = size_ + out.bytes.size();
  for (const auto& [opcode, at, length] : groups) {
    out.begin(Opcode::SummaryOffset);
    out.number(static_cast<std::uint8_t>(opcode));
    out.number(at);
    out.number(length);
    out.end();
  }
  out.begin(Opcode::Footer);
  out.number(begin);
  out.number(offsets);
  out.number(std::uint32_t{0});
  out.end();
  const std::size_t end = out.bytes.size() - sizeof(std::uint32_t);
  const std::uint32_t crc = crc32(std::span(out.bytes).first(end).subspan(data_end));
  std::memcpy(out.bytes.data() + end, &crc, sizeof crc);
  out.append(std::as_bytes(std::span(kMagic)));
  return std::move(out.bytes);
}

Status File::close() {
  Status first = write(summary());
  Status written = first;
  while (!written && !chunks_.empty()) {
    const ChunkPlace last = chunks_.back();
    chunks_.pop_back();
    chunk_index_.bytes.resize(last.index);
    counts_.resize(last.counts);
    lost_ += last.messages;
    size_ = last.offset;
    // What was written behind it goes too.
    auto is_gone = [&](const auto& placed) { return placed.offset >= size_; };
    std::erase_if(schemas_, is_gone);
    std::erase_if(channels_, is_gone);
    std::erase_if(metadata_, is_gone);
    static_cast<void>(::ftruncate(descriptor_.get(), static_cast<off_t>(size_)));
    written = write(summary());
  }
  descriptor_ = {};
  return first;
}

}  // namespace hc::mcap
