// SPDX-License-Identifier: Apache-2.0
#include <mcap/reader.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace hc::mcap {
namespace {

constexpr std::uint64_t kFooterLength = 20;

MessageRecord read_head(RecordReader& reader) {
  MessageRecord message;
  message.channel = reader.number<std::uint16_t>();
  message.sequence = reader.number<std::uint32_t>();
  message.log_time = reader.number<std::uint64_t>();
  message.publish_time = reader.number<std::uint64_t>();
  return message;
}

std::map<std::uint16_t, std::uint64_t> read_map(RecordReader list) {
  std::map<std::uint16_t, std::uint64_t> map;
  while (!list.at_end()) {
    const auto key = list.number<std::uint16_t>();
    map[key] = list.number<std::uint64_t>();
  }
  return map;
}

void add_time(Summary& summary, std::uint64_t begin, std::uint64_t end) {
  summary.begin = summary.begin == 0 ? begin : std::min(summary.begin, begin);
  summary.end = std::max(summary.end, end);
}

}  // namespace

Error Reader::damaged(const std::string& what, std::uint64_t at) const {
  return {Code::Malformed, "MCAP: " + what + ", at byte " + std::to_string(at)};
}

Error Reader::truncated(std::uint64_t at) const {
  return {Code::Truncated, "MCAP: the file has no end, as a recorder that was killed leaves it; " +
                               std::to_string(at) + " of its " + std::to_string(size_) +
                               " bytes are whole, and were read"};
}

Result<Reader> Reader::open(const std::string& path, const ReaderLimits& limits) {
  internal::Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!descriptor) return internal::system_error("open", path);
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) return internal::system_error("fstat", path);
  if (!S_ISREG(status.st_mode))
    return Error{Code::Unsupported, path + ": a recording in MCAP is a file, not a pipe or device"};
  Reader reader(path, std::move(descriptor), static_cast<std::uint64_t>(status.st_size), limits);
  auto magic = reader.read(0, kMagic.size(), kMagic.size());
  if (!magic && magic.error().code != Code::Truncated) return magic.error();
  if (!magic || std::memcmp(magic->data(), kMagic.data(), kMagic.size()) != 0)
    return Error{Code::Malformed, path + ": no MCAP file: it does not begin as one"};
  return reader;
}

Result<std::vector<std::byte>> Reader::read(std::uint64_t at, std::uint64_t size,
                                            std::uint64_t limit) {
  if (size > limit)
    return Error{Code::TooLarge, "MCAP: a record of " + std::to_string(size) + " bytes at byte " +
                                     std::to_string(at) + ", more than the limit of " +
                                     std::to_string(limit)};
  if (at > size_ || size > size_ - at) return truncated(at);
  std::vector<std::byte> bytes(size);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::pread(descriptor_.get(), bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return internal::system_error("read", path_);
    if (got == 0) return truncated(at);  // it has become shorter
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

Result<Reader::RecordPlace> Reader::record_at(std::uint64_t at) {
  auto head = read(at, kRecordHead, kRecordHead);
  if (!head) return head.error();
  RecordReader reader(*head);
  const auto opcode = static_cast<Opcode>(reader.number<std::uint8_t>());
  const RecordPlace place{opcode, at + kRecordHead, reader.number<std::uint64_t>()};
  if (place.length > size_ - place.content) return truncated(at);
  return place;
}

Status Reader::take(Opcode opcode, std::span<const std::byte> content, Summary& summary,
                    std::uint64_t at) {
  RecordReader reader(content);
  const bool is_kept = opcode == Opcode::Schema || opcode == Opcode::Channel;
  if (is_kept) {  // as often as one likes, with the same content
    const auto id = RecordReader(content).number<std::uint16_t>();
    if (opcode == Opcode::Schema ? summary.schemas.contains(id) : summary.channels.contains(id))
      return {};
    kept_ += content.size() + sizeof(ChannelRecord);
  }
  if (kept_ > limits_.summary_bytes)
    return Error{Code::TooLarge, "MCAP: schemas and channels of more than " +
                                     std::to_string(limits_.summary_bytes) + " bytes"};
  if (opcode == Opcode::Header) {
    reader.string();
    summary.library = reader.string();
  } else if (opcode == Opcode::Schema) {
    SchemaRecord schema;
    schema.id = reader.number<std::uint16_t>();
    schema.name = reader.string();
    schema.encoding = reader.string();
    schema.text = reader.string();
    if (reader.is_good()) summary.schemas[schema.id] = std::move(schema);
  } else if (opcode == Opcode::Channel) {
    ChannelRecord channel;
    channel.id = reader.number<std::uint16_t>();
    channel.schema = reader.number<std::uint16_t>();
    channel.topic = reader.string();
    channel.encoding = reader.string();
    channel.metadata = reader.words();
    if (reader.is_good()) summary.channels[channel.id] = std::move(channel);
  } else if (opcode == Opcode::Statistics) {
    summary.messages = reader.number<std::uint64_t>();
    reader.take(18);
    summary.begin = reader.number<std::uint64_t>();
    summary.end = reader.number<std::uint64_t>();
    summary.counts = read_map(reader.list());
  } else if (opcode == Opcode::ChunkIndex) {
    reader.take(32);  // times and place
    reader.list();
    reader.take(8);
    reader.string();
    reader.take(8);
    summary.plain += reader.number<std::uint64_t>();
    ++summary.chunks;
  } else if (opcode == Opcode::MetadataIndex) {
    reader.take(16);
    const auto name = reader.string();
    if (summary.metadata++ == 0) summary.first_metadata = name;
  }
  if (!reader.is_good()) return damaged("a record is shorter than what it holds", at);
  return {};
}

Result<Summary> Reader::summary() {
  Summary summary;
  kept_ = 0;
  if (auto header = record_at(kMagic.size()); header && header->opcode == Opcode::Header)
    if (auto content = read(header->content, header->length, limits_.summary_bytes))
      if (auto taken = take(Opcode::Header, *content, summary, header->content); !taken)
        return taken.error();
  auto ended = read_end(summary);
  if (!ended) return ended.error();
  if (*ended) return summary;
  kept_ = 0;
  return go_through();
}

/// Takes the summary at the end of the file; false where there is none.
Result<bool> Reader::read_end(Summary& summary) {
  const std::uint64_t tail = kRecordHead + kFooterLength + kMagic.size();
  if (size_ < kMagic.size() + tail) return false;
  auto end = read(size_ - tail, tail, tail);
  if (!end) return end.error();
  RecordReader footer(*end);
  const auto opcode = static_cast<Opcode>(footer.number<std::uint8_t>());
  const auto length = footer.number<std::uint64_t>();
  const auto begin = footer.number<std::uint64_t>();
  footer.number<std::uint64_t>();
  const auto crc = footer.number<std::uint32_t>();
  const auto magic = footer.take(kMagic.size());
  if (opcode != Opcode::Footer || length != kFooterLength ||
      std::memcmp(magic.data(), kMagic.data(), kMagic.size()) != 0)
    return false;
  if (begin == 0) return false;  // a file may have no summary
  const std::uint64_t footer_at = size_ - tail;
  if (begin < kMagic.size() || begin > footer_at)
    return damaged("the summary begins outside of the file", footer_at);
  // Record by record: of a recording of days it is long.
  std::uint32_t found_crc = 0;
  for (std::uint64_t at = begin; at < footer_at;) {
    auto place = record_at(at);
    if (!place) return place.error();
    if (place->end() > footer_at) return damaged("a record of the summary is cut short", at);
    auto bytes = read(at, place->end() - at, limits_.summary_bytes);
    if (!bytes) return bytes.error();
    found_crc = crc32(*bytes, found_crc);
    const auto content = std::span(*bytes).subspan(kRecordHead);
    if (auto taken = take(place->opcode, content, summary, at); !taken) return taken.error();
    at = place->end();
  }
  const auto head = std::span(*end).first(kRecordHead + 2 * sizeof(std::uint64_t));
  if (crc != 0 && crc32(head, found_crc) != crc)
    return damaged("the summary's CRC is wrong", begin);
  summary.is_whole = true;
  return true;
}

/// What a summary would say, as far as it can be known without the contents of chunks.
Result<Summary> Reader::go_through() {
  constexpr std::uint64_t kChunkHead = 64, kIndexHead = 6, kEntry = 16, kMaxName = 4096;
  Summary summary;
  for (std::uint64_t at = kMagic.size();;) {
    auto place = record_at(at);
    if (!place && place.error().code != Code::Truncated) return place.error();
    if (!place || place->opcode == Opcode::DataEnd || place->opcode == Opcode::Footer) {
      summary.is_whole = place.has_value();
      return summary;
    }
    const bool is_chunk = place->opcode == Opcode::Chunk;
    const bool is_index = place->opcode == Opcode::MessageIndex;
    const bool is_message = place->opcode == Opcode::Message;
    const bool is_metadata = place->opcode == Opcode::Metadata;
    const bool is_other = place->opcode == Opcode::Schema || place->opcode == Opcode::Channel ||
                          place->opcode == Opcode::Header;
    const std::uint64_t wanted = is_other                 ? place->length
                                 : is_metadata            ? std::min(place->length, kMaxName)
                                 : is_chunk || is_message ? std::min(place->length, kChunkHead)
                                 : is_index               ? std::min(place->length, kIndexHead)
                                                          : 0;
    auto content = read(place->content, wanted, limits_.summary_bytes);
    if (!content) return content.error();
    RecordReader reader(*content);
    if (is_other) {
      if (auto taken = take(place->opcode, *content, summary, at); !taken) return taken.error();
    } else if (is_metadata) {
      const auto name = reader.string();
      if (summary.metadata++ == 0) summary.first_metadata = name;
    } else if (is_chunk) {
      const auto first = reader.number<std::uint64_t>(), last = reader.number<std::uint64_t>();
      summary.plain += reader.number<std::uint64_t>();
      if (!reader.is_good()) return damaged("a chunk is shorter than its head", at);
      add_time(summary, first, last);
      ++summary.chunks;
    } else if (is_index && summary.chunks > 0) {
      const auto channel = reader.number<std::uint16_t>();
      const std::uint64_t count = reader.number<std::uint32_t>() / kEntry;
      summary.counts[channel] += count;
      summary.messages += count;
    } else if (is_message) {
      const auto message = read_head(reader);
      ++summary.counts[message.channel];
      ++summary.messages;
      add_time(summary, message.log_time, message.log_time);
    }
    at = place->end();
  }
}

Result<std::optional<Words>> Reader::metadata(std::string_view name) {
  std::optional<Words> found_words;
  for (std::uint64_t at = kMagic.size();;) {
    auto place = record_at(at);
    if (!place && place.error().code != Code::Truncated) return place.error();
    if (!place || place->opcode == Opcode::DataEnd || place->opcode == Opcode::Footer)
      return found_words;
    at = place->end();
    if (place->opcode != Opcode::Metadata) continue;
    auto content = read(place->content, place->length, limits_.summary_bytes);
    if (!content) return content.error();
    RecordReader reader(*content);
    if (reader.string() != name) continue;
    found_words = reader.words();
    if (!reader.is_good()) return damaged("a record is shorter than what it holds", place->content);
  }
}

Result<bool> Reader::is_skipped(const RecordPlace& chunk) {
  if (!selected_) return false;
  for (std::uint64_t at = chunk.end();;) {
    auto place = record_at(at);
    // Where the file ends here, there may have been more.
    if (!place) return place.error().code == Code::Truncated ? Result<bool>(false) : place.error();
    if (place->opcode != Opcode::MessageIndex) return at > chunk.end();
    auto channel = read(place->content, sizeof(std::uint16_t), sizeof(std::uint16_t));
    if (!channel) return channel.error();
    if (selected_->contains(RecordReader(*channel).number<std::uint16_t>())) return false;
    at = place->end();
  }
}

Status Reader::open_chunk(const RecordPlace& place) {
  auto content = read(place.content, place.length, limits_.chunk_bytes);
  if (!content) return content.error();
  auto plain = unpack_chunk(*content, limits_.chunk_bytes);
  if (!plain)
    return Error{plain.error().code,
                 plain.error().detail + ", at byte " + std::to_string(place.content - kRecordHead)};
  chunk_ = std::make_shared<const std::vector<std::byte>>(std::move(*plain));
  chunk_begin_ = place.content - kRecordHead;
  chunk_at_ = 0;
  return {};
}

Result<std::optional<StoredMessage>> Reader::next_of_chunk() {
  while (chunk_at_ < chunk_->size()) {
    const auto rest = std::span(*chunk_).subspan(chunk_at_);
    RecordReader reader(rest);
    const auto opcode = static_cast<Opcode>(reader.number<std::uint8_t>());
    const auto content = reader.take(reader.number<std::uint64_t>());
    if (!reader.is_good()) {
      chunk_ = nullptr;
      return damaged("a record reaches over the end of its chunk", chunk_begin_);
    }
    chunk_at_ += rest.size() - reader.left();
    if (opcode == Opcode::Schema || opcode == Opcode::Channel)
      if (auto taken = take(opcode, content, found, chunk_begin_); !taken) return taken.error();
    if (opcode != Opcode::Message) continue;  // a chunk has no others
    RecordReader message(content);
    StoredMessage stored{read_head(message), {}, chunk_};
    if (!message.is_good()) return damaged("a message is shorter than its head", chunk_begin_);
    if (selected_ && !selected_->contains(stored.record.channel)) continue;
    stored.data = content.last(message.left());
    return std::optional(std::move(stored));
  }
  chunk_ = nullptr;
  return std::optional<StoredMessage>();
}

Result<std::optional<StoredMessage>> Reader::next() {
  while (true) {
    if (chunk_ != nullptr) {
      auto message = next_of_chunk();
      if (!message || *message) return message;
    }
    const std::uint64_t begin = at_;
    auto place = record_at(begin);
    if (!place) return place.error();
    if (place->opcode == Opcode::DataEnd || place->opcode == Opcode::Footer)
      return std::optional<StoredMessage>();
    at_ = place->end();
    if (place->opcode == Opcode::Chunk) {
      auto skipped = is_skipped(*place);
      if (!skipped) return skipped.error();
      if (*skipped) continue;
      if (auto opened = open_chunk(*place); !opened) return opened.error();
    } else if (place->opcode == Opcode::Message) {
      auto content = read(place->content, place->length, limits_.chunk_bytes);
      if (!content) return content.error();
      auto owner = std::make_shared<const std::vector<std::byte>>(std::move(*content));
      RecordReader reader(*owner);
      StoredMessage stored{read_head(reader), {}, owner};
      if (!reader.is_good()) return damaged("a message is shorter than its head", begin);
      if (selected_ && !selected_->contains(stored.record.channel)) continue;
      stored.data = std::span(*owner).last(reader.left());
      return std::optional(std::move(stored));
    } else if (place->opcode == Opcode::Schema || place->opcode == Opcode::Channel) {
      auto content = read(place->content, place->length, limits_.summary_bytes);
      if (!content) return content.error();
      if (auto taken = take(place->opcode, *content, found, begin); !taken) return taken.error();
    }
  }
}

}  // namespace hc::mcap
