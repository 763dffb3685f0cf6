// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/reader.h>

#include <algorithm>
#include <iterator>

namespace hc::mcap {
namespace {

constexpr std::uint64_t kFooterLength = 20;
constexpr const char* kTooShort = "a record is too short for its fields";
constexpr std::uint64_t kRunBytes = std::uint64_t{4} << 20;  // of messages outside of chunks

MessageRecord read_head(RecordReader& reader) {
  MessageRecord message;
  reader.get(message.channel, message.sequence, message.log_time, message.publish_time);
  return message;
}

/// The next record's opcode and content.
std::pair<Opcode, std::span<const std::byte>> take_record(RecordReader& records) {
  Opcode opcode{};
  std::uint64_t length = 0;
  records.get(opcode, length);
  return {opcode, records.take(length)};
}

Error damaged(const std::string& what, std::uint64_t at) {
  return {Code::Malformed, "MCAP: " + what + ", at byte " + std::to_string(at)};
}

/// Whether all channels with messages have been declared.
bool knows_channels(const Summary& summary) {
  return std::ranges::all_of(
      summary.counts, [&](const auto& each) { return summary.channels.contains(each.first); });
}

}  // namespace

Result<Reader> Reader::open(const std::string& path, const ReaderLimits& limits) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  Reader reader(std::move(*file), limits);
  auto chunks = reader.read_summary();
  if (!chunks) return chunks.error();
  if (auto scanned = reader.scan(*chunks); !scanned) return scanned.error();
  reader.count_contents();
  std::ranges::stable_sort(reader.parts_, {}, &Part::first);
  return reader;
}

Status Reader::declare(const RecordPlace& place, std::span<const std::byte> content) {
  RecordReader reader(content);
  bool is_new = false;  // declarations may be repeated
  if (place.opcode == Opcode::Schema) {
    SchemaRecord schema;
    reader.get(schema.id, schema.name, schema.encoding, schema.text);
    is_new = reader.is_good() && summary_.schemas.try_emplace(schema.id, schema).second;
  } else {
    ChannelRecord channel;
    reader.get(channel.id, channel.schema, channel.topic, channel.encoding, channel.metadata);
    is_new = reader.is_good() && summary_.channels.try_emplace(channel.id, channel).second;
  }
  if (!reader.is_good()) return damaged(kTooShort, place.at);
  if (is_new) declared_ += content.size() + sizeof(ChannelRecord);
  if (declared_ <= limits_.summary_bytes) return {};
  return Error{Code::TooLarge, "MCAP: schemas and channels of more than " +
                                   std::to_string(limits_.summary_bytes) + " bytes"};
}

void Reader::add_times(const Part& part) {
  if (part.first == 0 && part.last == 0) return;  // a chunk without messages
  summary_.begin = summary_.begin == 0 ? part.first : std::min(summary_.begin, part.first);
  summary_.end = std::max(summary_.end, part.last);
}

void Reader::add_chunk(const Part& chunk) {
  parts_.push_back(chunk);
  add_times(chunk);
  summary_.plain += chunk.plain;
  ++summary_.chunks;
}

Result<std::vector<Reader::Part>> Reader::read_summary() {
  std::vector<Part> chunks;
  const std::uint64_t tail = kRecordHead + kFooterLength + kMagic.size();
  if (file_.size() < kMagic.size() + tail) return chunks;
  const std::uint64_t footer_at = file_.size() - tail;
  auto end = file_.read(footer_at, tail, tail);
  if (!end) return end.error();
  RecordReader footer(*end);
  Opcode opcode{};
  std::uint64_t length = 0, begin = 0, offsets = 0;
  std::uint32_t crc = 0;
  footer.get(opcode, length, begin, offsets, crc);
  const bool has_footer =
      opcode == Opcode::Footer && length == kFooterLength &&
      std::memcmp(end->data() + (tail - kMagic.size()), kMagic.data(), kMagic.size()) == 0;
  if (!has_footer || begin == 0) return chunks;  // a file may have no summary
  if (begin < kMagic.size() || begin > footer_at)
    return damaged("the summary begins outside of the file", footer_at);
  // Record by record, since the summary of a recording of days is long.
  std::uint32_t found_crc = 0;
  for (std::uint64_t at = begin; at < footer_at;) {
    auto place = file_.record_at(at);
    if (!place) return place.error();
    if (place->end() > footer_at) return damaged("a record of the summary is cut short", at);
    auto bytes = file_.read(at, place->end() - at, limits_.summary_bytes);
    if (!bytes) return bytes.error();
    found_crc = crc32(*bytes, found_crc);
    const auto content = std::span(*bytes).subspan(kRecordHead);
    RecordReader reader(content);
    if (place->opcode == Opcode::Schema || place->opcode == Opcode::Channel) {
      if (auto declared = declare(*place, content); !declared) return declared.error();
    } else if (place->opcode == Opcode::Statistics) {
      reader.take(42);
      reader.get(summary_.counts);
    } else if (place->opcode == Opcode::ChunkIndex) {
      Part chunk{.is_chunk = true, .is_counted = true};
      std::uint64_t size = 0, indexes_size = 0, compressed = 0;
      std::string indexes, compression;
      reader.get(chunk.first, chunk.last, chunk.at, size, indexes, indexes_size, compression,
                 compressed, chunk.plain);
      chunk.end = chunk.at + size;
      chunk.indexed = chunk.end + indexes_size;
      if (chunk.at < chunk.end && chunk.end <= chunk.indexed && chunk.indexed <= begin)
        chunks.push_back(chunk);
    }
    if (!reader.is_good()) return damaged(kTooShort, at);
    at = place->end();
  }
  const auto head = std::span(*end).first(kRecordHead + 2 * sizeof(std::uint64_t));
  if (crc != 0 && crc32(head, found_crc) != crc)
    return damaged("the summary's CRC is wrong", begin);
  if (summary_.counts.empty()) chunks.clear();
  std::ranges::sort(chunks, {}, &Part::at);
  return chunks;
}

Status Reader::scan(const std::vector<Part>& chunks) {
  const bool is_counted = !summary_.counts.empty();
  while (true) {
    const auto known = std::ranges::lower_bound(chunks, scanned_, {}, &Part::at);
    if (known != chunks.end() && known->at == scanned_) {
      add_chunk(*known);
      scanned_ = known->indexed;
      continue;
    }
    auto place = file_.record_at(scanned_);
    if (!place && place.error().code != Code::Truncated) return place.error();
    summary_.is_whole = place.has_value();
    if (!place || place->opcode == Opcode::DataEnd || place->opcode == Opcode::Footer) return {};
    scanned_ = place->end();
    if (auto taken = scan_record(*place, is_counted); !taken) return taken;
  }
}

Status Reader::scan_record(const RecordPlace& place, bool is_counted) {
  constexpr std::uint64_t kHead = 64, kEntry = 16, kMaxName = 4096;
  const bool declares = place.opcode == Opcode::Schema || place.opcode == Opcode::Channel;
  const bool is_metadata = place.opcode == Opcode::Metadata;
  const bool has_name = is_metadata || place.opcode == Opcode::Header;
  const std::uint64_t most = declares ? place.length : has_name ? kMaxName : kHead;
  auto content = file_.read(place.content(), std::min(place.length, most), limits_.summary_bytes);
  if (!content) return content.error();
  if (declares) return declare(place, *content);
  const bool is_behind_chunk = !parts_.empty() && parts_.back().is_chunk;
  RecordReader reader(*content);
  if (place.opcode == Opcode::Header) {
    reader.get(summary_.profile);
  } else if (is_metadata) {
    metadata_.push_back(place);
    reader.get(summary_.metadata.emplace_back());
  } else if (place.opcode == Opcode::Chunk) {
    Part chunk{.at = place.at, .end = place.end(), .is_chunk = true, .is_counted = is_counted};
    reader.get(chunk.first, chunk.last, chunk.plain);
    add_chunk(chunk);
  } else if (place.opcode == Opcode::MessageIndex && is_behind_chunk && !is_counted) {
    std::uint16_t channel = 0;
    std::uint32_t size = 0;
    reader.get(channel, size);
    summary_.counts[channel] += size / kEntry;
    parts_.back().is_counted = true;
  } else if (place.opcode == Opcode::Message) {
    const auto message = read_head(reader);
    const auto time = message.log_time;
    if (!is_counted) ++summary_.counts[message.channel];
    if (parts_.empty() || is_behind_chunk || place.end() - parts_.back().at > kRunBytes)
      parts_.push_back({.first = time, .at = place.at, .is_counted = true});
    auto& run = parts_.back();
    run.end = place.end();
    run.first = std::min(run.first, time);
    run.last = std::max(run.last, time);
    add_times(run);
  }
  return {};
}

void Reader::count_contents() {
  for (const auto& part : parts_) {
    if (part.is_counted && knows_channels(summary_)) continue;
    auto opened = open(part, [&](const MessageRecord& message) {
      if (!part.is_counted) ++summary_.counts[message.channel];
      return false;
    });
    if (!opened && summary_.unread++ == 0) summary_.why_unread = opened.error().detail;
  }
}

Result<std::vector<MetadataRecord>> Reader::metadata() {
  std::vector<MetadataRecord> all;
  std::uint64_t kept = 0;
  for (const auto& place : metadata_) {
    auto content = file_.read(place.content(), place.length, limits_.summary_bytes - kept);
    if (!content) return content.error();
    kept += content->size();
    RecordReader reader(*content);
    auto& record = all.emplace_back();
    reader.get(record.name, record.words);
    if (!reader.is_good()) return damaged(kTooShort, place.at);
  }
  return all;
}

Result<bool> Reader::is_skipped(const Part& part) {
  if (part.last < start_) return true;
  if (!selected_ || !part.is_chunk) return false;
  for (std::uint64_t at = part.end;;) {
    auto place = file_.record_at(at);
    // If the file ends here, further indexes may be missing.
    if (!place) return place.error().code == Code::Truncated ? Result<bool>(false) : place.error();
    if (place->opcode != Opcode::MessageIndex) return at > part.end;
    std::uint16_t channel = 0;
    auto bytes = file_.read(place->content(), sizeof channel, sizeof channel);
    if (!bytes) return bytes.error();
    RecordReader(*bytes).get(channel);
    if (selected_->contains(channel)) return false;
    at = place->end();
  }
}

Result<std::vector<Reader::Pending>> Reader::open(
    const Part& part, const std::function<bool(const MessageRecord&)>& is_wanted) {
  auto read_bytes = file_.read(part.at, part.end - part.at, limits_.chunk_bytes);
  if (!read_bytes) return read_bytes.error();
  const auto owner = std::make_shared<const std::vector<std::byte>>(std::move(*read_bytes));
  Bytes bytes{*owner, owner};
  if (part.is_chunk) {
    RecordReader record(bytes.span);
    const auto [opcode, content] = take_record(record);
    if (opcode != Opcode::Chunk) return damaged("the index does not lead to a chunk", part.at);
    auto plain = unpack_chunk({content, owner}, limits_.chunk_bytes);
    if (!plain)
      return Error{plain.error().code,
                   plain.error().detail + ", at byte " + std::to_string(part.at)};
    bytes = std::move(*plain);
  }
  const auto opened = std::make_shared<OpenPart>();
  opened->bytes = std::move(bytes);
  std::vector<Pending> messages;
  RecordReader records(opened->bytes.span);
  while (!records.at_end()) {
    const std::uint64_t at = opened->bytes.span.size() - records.left();
    const auto [opcode, content] = take_record(records);
    if (!records.is_good()) return damaged("a record extends beyond its chunk", part.at);
    if (opcode == Opcode::Schema || opcode == Opcode::Channel)
      if (auto declared = declare({opcode, part.at, 0}, content); !declared)
        return declared.error();
    if (opcode != Opcode::Message) continue;  // other records are ignored
    RecordReader reader(content);
    const auto message = read_head(reader);
    if (!reader.is_good()) return damaged("a message is shorter than its head", part.at);
    if (is_wanted(message)) messages.push_back({message.log_time, at, opened});
  }
  return messages;
}

Result<bool> Reader::fill() {
  while (true) {
    const bool has_part = next_part_ < parts_.size();
    const bool has_message = next_ < pending_.size();
    if (has_message && (!has_part || open_bytes_ > limits_.chunk_bytes ||
                        parts_[next_part_].first >= pending_[next_].time))
      return true;
    if (!has_part) {
      if (summary_.is_whole || std::exchange(is_truncation_reported_, true)) return false;
      return file_.truncated(scanned_);
    }
    const Part& part = parts_[next_part_++];
    position_ += part.end - part.at;
    auto skipped = is_skipped(part);
    if (!skipped) return skipped.error();
    if (*skipped) continue;
    auto opened = open(part, [&](const MessageRecord& message) {
      return message.log_time >= start_ && (!selected_ || selected_->contains(message.channel));
    });
    if (!opened) return opened.error();
    if (opened->empty()) continue;
    opened->front().part->left = opened->size();
    open_bytes_ += opened->front().part->bytes.span.size();
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(next_));
    next_ = 0;
    std::ranges::move(*opened, std::back_inserter(pending_));
    if (!std::ranges::is_sorted(pending_, {}, &Pending::time))
      std::ranges::stable_sort(pending_, {}, &Pending::time);
  }
}

void Reader::pop() {
  auto part = std::move(pending_[next_++].part);
  if (--part->left == 0) open_bytes_ -= part->bytes.span.size();
}

void Reader::start_at(std::uint64_t log_time) {
  start_ = log_time;
  while (next_ < pending_.size() && pending_[next_].time < start_) pop();
}

Result<std::optional<std::uint64_t>> Reader::next_time() {
  auto filled = fill();
  if (!filled) return filled.error();
  return *filled ? std::optional(pending_[next_].time) : std::nullopt;
}

Result<std::optional<StoredMessage>> Reader::next() {
  auto filled = fill();
  if (!filled) return filled.error();
  if (!*filled) return std::optional<StoredMessage>();
  const auto part = pending_[next_].part;
  RecordReader record(part->bytes.span.subspan(pending_[next_].at));
  pop();
  const auto content = take_record(record).second;
  RecordReader reader(content);
  StoredMessage stored{read_head(reader),      nullptr, nullptr, {}, part->bytes.owner,
                       part->bytes.span.size()};
  stored.data = content.last(reader.left());
  const auto channel = summary_.channels.find(stored.record.channel);
  if (channel == summary_.channels.end())
    return Error{Code::Malformed, "MCAP: a message of channel " +
                                      std::to_string(stored.record.channel) +
                                      ", which is not declared"};
  stored.channel = &channel->second;
  if (const auto schema = summary_.schemas.find(channel->second.schema);
      schema != summary_.schemas.end())
    stored.schema = &schema->second;
  return std::optional(std::move(stored));
}

}  // namespace hc::mcap
