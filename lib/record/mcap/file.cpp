// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/file.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include <hc/os/new_file.h>

namespace hc::mcap {
Result<File> File::create(const std::string& path, std::string_view profile) {
  auto begun = begin_file(path);
  if (!begun) return begun.error();
  File file(std::move(begun->path), std::move(begun->descriptor));
  RecordWriter out;
  out.append(std::as_bytes(std::span(kMagic)));
  out.add(Opcode::Header, profile, "hypercolumn " HC_VERSION);
  if (auto written = file.write(out.bytes); !written) return written.error();
  return file;
}

Status File::write(std::span<const std::byte> bytes) {
  const std::uint64_t begin = size_;
  while (!bytes.empty()) {
    auto size = system_call("write", path_, [&] {
      return ::pwrite(descriptor_.get(), bytes.data(), bytes.size(), static_cast<off_t>(size_));
    });
    if (!size) {
      size_ = begin;
      [[maybe_unused]] const int cut = ::ftruncate(descriptor_.get(), static_cast<off_t>(begin));
      return size.error();
    }
    size_ += static_cast<std::uint64_t>(*size);
    bytes = bytes.subspan(static_cast<std::size_t>(*size));
  }
  return {};
}

/// Reserves space after the end of the file, if the file system supports it.
Status File::reserve(std::uint64_t bytes) const {
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && size_ + bytes > limit.rlim_cur)
    return system_error("write", path_, EFBIG);
  const int reserved = ::fallocate(descriptor_.get(), FALLOC_FL_KEEP_SIZE,
                                   static_cast<off_t>(size_), static_cast<off_t>(bytes));
  if (reserved == 0 || (errno != ENOSPC && errno != EDQUOT)) return {};
  return system_error("write", path_);
}

Status File::append(std::span<const std::byte> records, Opcode opcode,
                    std::span<const std::byte> in_summary) {
  // The rest of the summary: the count of each channel, the statistics and the offsets.
  constexpr std::uint64_t kOfChannel = 16, kOther = 1024;
  auto& group = summary_[opcode];
  std::uint64_t room = in_summary.size() + kOther;
  room += kOfChannel * (summary_[Opcode::Channel].count + 1);
  for (const auto& [each, noted] : summary_) room += noted.records.bytes.size();
  if (auto reserved = reserve(records.size() + room); !reserved) return reserved;
  if (auto written = write(records); !written) return written;
  group.records.append(in_summary);
  ++group.count;
  return {};
}

Status File::add(const SchemaRecord& schema) {
  RecordWriter out;
  out.add(Opcode::Schema, schema.id, schema.name, schema.encoding, schema.text);
  return append(out.bytes, Opcode::Schema, out.bytes);
}

Status File::add(const ChannelRecord& channel) {
  RecordWriter out;
  out.add(Opcode::Channel, channel.id, channel.schema, channel.topic, channel.encoding,
          channel.metadata);
  return append(out.bytes, Opcode::Channel, out.bytes);
}

Status File::add(const MetadataRecord& metadata) {
  RecordWriter out, index;
  out.add(Opcode::Metadata, metadata.name, metadata.words);
  index.add(Opcode::MetadataIndex, size_, std::uint64_t{out.bytes.size()}, metadata.name);
  return append(out.bytes, Opcode::MetadataIndex, index.bytes);
}

Status File::add(const Chunk& chunk) {
  std::map<std::uint16_t, std::uint64_t> offsets;
  for (const auto& [channel, each] : chunk.indexes) offsets[channel] = size_ + each.offset;
  RecordWriter index;
  index.add(Opcode::ChunkIndex, chunk.begin, chunk.end, size_, chunk.length, offsets,
            std::uint64_t{chunk.bytes.size() - chunk.length}, chunk.compression, chunk.compressed,
            chunk.plain);
  if (auto added = append(chunk.bytes, Opcode::ChunkIndex, index.bytes); !added) return added;
  const bool is_first = summary_[Opcode::ChunkIndex].count == 1;
  begin_ = is_first ? chunk.begin : std::min(begin_, chunk.begin);
  end_ = std::max(end_, chunk.end);
  for (const auto& [channel, each] : chunk.indexes) counts_[channel] += each.count;
  return {};
}

std::vector<std::byte> File::summary() {
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : counts_) messages += count;
  auto count = [&](Opcode opcode) { return summary_[opcode].count; };
  const auto schemas = static_cast<std::uint16_t>(count(Opcode::Schema));
  constexpr std::uint32_t kAttachments = 0, kNoCrc = 0;
  summary_[Opcode::Statistics].records.add(
      Opcode::Statistics, messages, schemas, count(Opcode::Channel), kAttachments,
      count(Opcode::MetadataIndex), count(Opcode::ChunkIndex), begin_, end_, counts_);

  RecordWriter out, offsets;
  out.add(Opcode::DataEnd, kNoCrc);
  const std::size_t begin = out.bytes.size();
  for (const auto& [opcode, group] : summary_) {
    const std::uint64_t at = size_ + out.bytes.size(), length = group.records.bytes.size();
    out.append(group.records.bytes);
    if (length > 0) offsets.add(Opcode::SummaryOffset, opcode, at, length);
  }
  const std::uint64_t offsets_at = size_ + out.bytes.size();
  out.append(offsets.bytes);
  out.add(Opcode::Footer, size_ + begin, offsets_at, kNoCrc);
  const auto crc_at = out.bytes.size() - sizeof(std::uint32_t);
  out.set(crc_at, crc32(std::span(out.bytes).first(crc_at).subspan(begin)));
  out.append(std::as_bytes(std::span(kMagic)));
  return std::move(out.bytes);
}

Status File::close() {
  auto written = write(summary());
  descriptor_ = {};
  return written;
}

}  // namespace hc::mcap
