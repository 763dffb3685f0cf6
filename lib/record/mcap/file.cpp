// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/file.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include <hc/os/new_file.h>

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

Result<File> File::create(const std::string& path) {
  auto begun = begin_file(path);
  if (!begun) return begun.error();
  File file(std::move(begun->path), std::move(begun->descriptor));
  constexpr std::size_t kHeader = 64;
  RecordWriter out;
  out.bytes.reserve(kHeader);
  out.append(std::as_bytes(std::span(kMagic)));
  out.begin(Opcode::Header);
  out.string("ros2");
  out.string("hypercolumn 0.1");
  out.end();
  if (auto written = file.append(out.bytes); !written) return written.error();
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
      [[maybe_unused]] const int cut = ::ftruncate(descriptor_.get(), static_cast<off_t>(begin));
      return error;
    }
    size_ += static_cast<std::uint64_t>(size);
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return {};
}

/// Reserves so many bytes behind what is there, where the file system can do that.
Status File::reserve(std::uint64_t bytes) const {
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && size_ + bytes > limit.rlim_cur)
    return internal::system_error("write", path_, EFBIG);
  const int reserved = ::fallocate(descriptor_.get(), FALLOC_FL_KEEP_SIZE,
                                   static_cast<off_t>(size_), static_cast<off_t>(bytes));
  if (reserved == 0 || (errno != ENOSPC && errno != EDQUOT)) return {};
  return internal::system_error("write", path_);
}

Status File::append(std::span<const std::byte> bytes) {
  // What else the summary says: of each channel, of the next chunk, and its own parts.
  constexpr std::uint64_t kOfChannel = 64, kOther = 1024;
  const std::uint64_t summary =
      repeated_ + chunk_index_.bytes.size() + kOfChannel * channels_.size() + kOther;
  if (auto reserved = reserve(bytes.size() + summary); !reserved) return reserved;
  return write(bytes);
}

template <typename T>
Status File::add_record(const T& record, std::vector<Placed<T>>& placed) {
  RecordWriter out;
  write_record(out, record);
  const std::uint64_t offset = size_;
  repeated_ += out.bytes.size();
  auto written = append(out.bytes);
  if (written)
    placed.push_back({record, offset});
  else
    repeated_ -= out.bytes.size();
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
  constexpr std::uint64_t kOfIndex = 32;
  auto written = append(out.bytes);
  if (!written) return written;
  metadata_.push_back(place);
  repeated_ += kOfIndex + metadata.name.size();
  return {};
}

Status File::add(const PackedChunk& chunk) {
  ChunkInfo info = chunk.info;
  info.offset = size_;
  for (auto& [channel, offset] : info.index_offsets) offset += size_;
  if (auto written = append(chunk.bytes); !written) return written;
  first_ = chunks_ == 0 ? info.begin : std::min(first_, info.begin);
  last_ = std::max(last_, info.end);
  ++chunks_;
  write_chunk_index(chunk_index_, info);
  for (const auto& [channel, count] : info.counts) counts_[channel] += count;
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

  std::uint64_t messages = 0;
  for (const auto& [channel, count] : counts_) messages += count;
  out.begin(Opcode::Statistics);
  out.number(messages);
  out.number(static_cast<std::uint16_t>(schemas_.size()));
  out.number(static_cast<std::uint32_t>(channels_.size()));
  out.number(std::uint32_t{0});
  out.number(static_cast<std::uint32_t>(metadata_.size()));
  out.number(chunks_);
  out.number(first_);
  out.number(last_);
  write_map(out, counts_);
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
  auto written = write(summary());
  descriptor_ = {};
  return written;
}

}  // namespace hc::mcap
