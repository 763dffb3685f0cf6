// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/reader.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace hc::mcap {
namespace {

constexpr std::uint64_t kFooterLength = 20;
constexpr std::uint64_t kRunBytes = std::uint64_t{4} << 20;  // of messages that are in no chunk

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
  // A file's summary need not repeat channels, or count messages.
  const bool has_all = std::ranges::all_of(
      summary.counts, [&](const auto& each) { return summary.channels.contains(each.first); });
  if (*ended && has_all && !summary.counts.empty()) return summary;
  if (auto scanned = scan(); !scanned) return scanned.error();
  Summary heads = heads_;
  count_contents(heads);
  return heads;
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

Status Reader::scan() {
  if (is_scanned_) return {};
  while (true) {
    auto place = record_at(scanned_);
    if (!place && place.error().code != Code::Truncated) return place.error();
    heads_.is_whole = place.has_value();
    is_scanned_ = !place || place->opcode == Opcode::DataEnd || place->opcode == Opcode::Footer;
    if (is_scanned_) break;
    const auto at = std::exchange(scanned_, place->end());
    if (auto taken = scan_record(*place, at); !taken) return taken;
  }
  found.schemas.insert(heads_.schemas.begin(), heads_.schemas.end());
  found.channels.insert(heads_.channels.begin(), heads_.channels.end());
  return {};
}

Status Reader::scan_record(const RecordPlace& place, std::uint64_t at) {
  constexpr std::uint64_t kHead = 64, kEntry = 16, kMaxName = 4096;
  const bool is_kept = place.opcode == Opcode::Schema || place.opcode == Opcode::Channel ||
                       place.opcode == Opcode::Header;
  const std::uint64_t most = is_kept                            ? place.length
                             : place.opcode == Opcode::Metadata ? kMaxName
                                                                : kHead;
  auto content = read(place.content, std::min(place.length, most), limits_.summary_bytes);
  if (!content) return content.error();
  if (is_kept) return take(place.opcode, *content, heads_, at);
  RecordReader reader(*content);
  if (place.opcode == Opcode::Metadata) {
    const auto name = reader.string();
    if (heads_.metadata++ == 0) heads_.first_metadata = name;
    metadata_.emplace_back(name, place);
  } else if (place.opcode == Opcode::Chunk) {
    const auto first = reader.number<std::uint64_t>(), last = reader.number<std::uint64_t>();
    heads_.plain += reader.number<std::uint64_t>();
    if (!reader.is_good()) return damaged("a chunk is shorter than its head", at);
    parts_.push_back({first, last, at, place.end(), true, false});
    if (first != 0 || last != 0) add_time(heads_, first, last);  // both are 0 of an empty one
    ++heads_.chunks;
  } else if (place.opcode == Opcode::MessageIndex && !parts_.empty() && parts_.back().is_chunk) {
    const auto channel = reader.number<std::uint16_t>();
    const std::uint64_t count = reader.number<std::uint32_t>() / kEntry;
    heads_.counts[channel] += count;
    heads_.messages += count;
    parts_.back().has_index = true;
  } else if (place.opcode == Opcode::Message) {
    const auto message = read_head(reader);
    if (!reader.is_good()) return damaged("a message is shorter than its head", at);
    ++heads_.counts[message.channel];
    ++heads_.messages;
    add_time(heads_, message.log_time, message.log_time);
    if (parts_.empty() || parts_.back().is_chunk || place.end() - parts_.back().at > kRunBytes)
      parts_.push_back({message.log_time, message.log_time, at, at, false, true});
    auto& run = parts_.back();
    run.end = place.end();
    run.first = std::min(run.first, message.log_time);
    run.last = std::max(run.last, message.log_time);
  }
  return {};
}

void Reader::count_contents(Summary& summary) {
  for (const auto& part : parts_) {
    const bool has_all = std::ranges::all_of(
        summary.counts, [&](const auto& each) { return summary.channels.contains(each.first); });
    if (part.has_index && has_all) continue;
    auto opened = open(part, summary);
    if (!opened && summary.unread++ == 0) summary.why_unread = opened.error().detail;
    if (!opened || part.has_index) continue;
    summary.messages += opened->messages.size();
    for (const auto& [time, at] : opened->messages) {
      RecordReader reader(std::span(*opened->bytes).subspan(at + kRecordHead));
      ++summary.counts[reader.number<std::uint16_t>()];
    }
  }
}

Result<std::map<std::string, Words>> Reader::metadata() {
  if (auto scanned = scan(); !scanned) return scanned.error();
  std::map<std::string, Words> all;
  std::uint64_t kept = 0;
  for (const auto& [name, place] : metadata_) {
    auto content = read(place.content, place.length, limits_.summary_bytes - kept);
    if (!content) return content.error();
    kept += content->size();
    RecordReader reader(*content);
    const std::string key(reader.string());
    all[key] = reader.words();
    if (!reader.is_good()) return damaged("a record is shorter than what it holds", place.content);
  }
  return all;
}

Result<bool> Reader::is_skipped(const Part& chunk) {
  if (chunk.last < start_) return true;
  if (!selected_ || !chunk.is_chunk) return false;
  for (std::uint64_t at = chunk.end;;) {
    auto place = record_at(at);
    // Where the file ends here, there may have been more.
    if (!place) return place.error().code == Code::Truncated ? Result<bool>(false) : place.error();
    if (place->opcode != Opcode::MessageIndex) return at > chunk.end;
    auto channel = read(place->content, sizeof(std::uint16_t), sizeof(std::uint16_t));
    if (!channel) return channel.error();
    if (selected_->contains(RecordReader(*channel).number<std::uint16_t>())) return false;
    at = place->end();
  }
}

Result<Reader::OpenPart> Reader::open(const Part& part, Summary& summary) {
  const auto head = part.is_chunk ? kRecordHead : 0;
  auto bytes = read(part.at + head, part.end - part.at - head, limits_.chunk_bytes);
  if (!bytes) return bytes.error();
  if (part.is_chunk) {
    bytes = unpack_chunk(*bytes, limits_.chunk_bytes);
    if (!bytes)
      return Error{bytes.error().code,
                   bytes.error().detail + ", at byte " + std::to_string(part.at)};
  }
  OpenPart opened{std::make_shared<const std::vector<std::byte>>(std::move(*bytes)), {}, 0};
  RecordReader records(*opened.bytes);
  while (!records.at_end()) {
    const std::uint64_t at = opened.bytes->size() - records.left();
    const auto opcode = static_cast<Opcode>(records.number<std::uint8_t>());
    const auto content = records.take(records.number<std::uint64_t>());
    if (!records.is_good()) return damaged("a record reaches over the end of its chunk", part.at);
    if (opcode == Opcode::Schema || opcode == Opcode::Channel)
      if (auto taken = take(opcode, content, summary, part.at); !taken) return taken.error();
    if (opcode != Opcode::Message) continue;  // a chunk has no others
    RecordReader reader(content);
    const auto message = read_head(reader);
    if (!reader.is_good()) return damaged("a message is shorter than its head", part.at);
    opened.messages.emplace_back(message.log_time, at);
  }
  return opened;
}

Result<Reader::OpenPart*> Reader::front() {
  if (auto scanned = scan(); !scanned) return scanned.error();
  if (!std::exchange(is_sorted_, true)) std::ranges::stable_sort(parts_, {}, &Part::first);
  while (true) {
    auto first = open_.begin();
    for (auto each = open_.begin(); each != open_.end(); ++each)
      if (each->second.time() < first->second.time()) first = each;
    const bool has_next = next_part_ < parts_.size();
    if (!open_.empty() && (!has_next || parts_[next_part_].first >= first->second.time() ||
                           open_bytes_ > limits_.chunk_bytes))
      return &first->second;
    if (!has_next) return heads_.is_whole ? Result<OpenPart*>(nullptr) : truncated(scanned_);
    const auto number = next_part_++;
    const Part& part = parts_[number];
    position_ += part.end - part.at;
    auto skipped = is_skipped(part);
    if (!skipped) return skipped.error();
    if (*skipped) continue;
    auto opened = open(part, found);
    if (!opened) return opened.error();
    std::erase_if(opened->messages, [&](const auto& message) {
      RecordReader reader(std::span(*opened->bytes).subspan(message.second + kRecordHead));
      const auto channel = reader.number<std::uint16_t>();
      return message.first < start_ || (selected_ && !selected_->contains(channel));
    });
    if (opened->messages.empty()) continue;
    const auto by_time = [](const auto& each) { return each.first; };
    if (!std::ranges::is_sorted(opened->messages, {}, by_time))
      std::ranges::stable_sort(opened->messages, {}, by_time);
    open_bytes_ += opened->bytes->size();
    open_.emplace(number, std::move(*opened));
  }
}

void Reader::start_at(std::uint64_t log_time) {
  start_ = log_time;
  for (auto& [number, part] : open_)
    while (part.next < part.messages.size() && part.time() < start_) ++part.next;
  close_parts();
}

void Reader::close_parts() {
  std::erase_if(open_, [&](const auto& each) {
    const bool is_read = each.second.next == each.second.messages.size();
    if (is_read) open_bytes_ -= each.second.bytes->size();
    return is_read;
  });
}

Result<std::optional<std::uint64_t>> Reader::next_time() {
  auto part = front();
  if (!part) return part.error();
  return *part != nullptr ? std::optional((*part)->time()) : std::nullopt;
}

Result<std::optional<StoredMessage>> Reader::next() {
  auto found_part = front();
  if (!found_part) return found_part.error();
  OpenPart* part = *found_part;
  if (part == nullptr) return std::optional<StoredMessage>();
  RecordReader record(std::span(*part->bytes).subspan(part->messages[part->next].second + 1));
  const auto content = record.take(record.number<std::uint64_t>());
  RecordReader reader(content);
  StoredMessage stored{read_head(reader), {}, part->bytes};
  stored.data = content.last(reader.left());
  if (++part->next == part->messages.size()) close_parts();
  return std::optional(std::move(stored));
}

}  // namespace hc::mcap
