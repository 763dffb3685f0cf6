// SPDX-License-Identifier: Apache-2.0
// Streams of MTP in MCAP files (doc/recordings.md, "In the file").
#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <hc/base/suggestion.h>
#include <record/reader.h>
#include <ros/messages.h>
#include <ros/schema.h>

namespace hc::record {
namespace {

using mcap::ChannelRecord;
using mcap::SchemaRecord;
using mcap::StoredMessage;
using mcap::Summary;

bool is_matrix(const ChannelRecord& channel, const SchemaRecord* schema) {
  return channel.encoding == "cdr" && schema != nullptr &&
         schema->name == ros::schema(ros::Type::Matrix).name;
}

const SchemaRecord* schema_of(const Summary& summary, const ChannelRecord& channel) {
  const auto schema = summary.schemas.find(channel.schema);
  return schema != summary.schemas.end() ? &schema->second : nullptr;
}

std::string stream_name(const ChannelRecord& channel) {
  const auto name = channel.metadata.find(kStreamKey);
  return name != channel.metadata.end() ? name->second : channel.topic;
}

std::int64_t signed_time(std::uint64_t time) {
  return static_cast<std::int64_t>(
      std::min<std::uint64_t>(time, std::numeric_limits<std::int64_t>::max()));
}

class McapReader final : public Reader {
 public:
  McapReader(mcap::Reader reader, const Limits& limits)
      : reader_(std::move(reader)), limits_(limits) {}

  Result<Got> take(Message& message) override {
    message = {};
    while (true) {
      auto stored = reader_.next();
      if (!stored) return stored.error();
      if (!*stored) return Got::End;
      const auto& channel = *(*stored)->channel;
      if (!is_mtp(**stored)) {
        const auto beside = channel.metadata.find(kBesideKey);
        if (beside != channel.metadata.end()) keep(beside->second, std::move(**stored));
        continue;
      }
      auto made = rebuild(**stored);
      if (!made) return made.error();
      message = std::move(*made);
      stream_ = stream_name(channel);
      log_time_ = signed_time((*stored)->record.log_time);
      ++traffic_.messages;
      return Got::Message;
    }
  }

  Result<std::optional<StoredMessage>> take_raw() override { return reader_.next(); }
  Result<std::optional<std::int64_t>> next_time() override {
    auto time = reader_.next_time();
    if (!time) return time.error();
    return *time ? std::optional(signed_time(**time)) : std::nullopt;
  }

  [[nodiscard]] std::int64_t log_time() const override { return log_time_; }
  [[nodiscard]] std::string_view stream() const override { return stream_; }
  void start_at(std::int64_t log_time) override {
    reader_.start_at(static_cast<std::uint64_t>(log_time));
  }
  [[nodiscard]] int descriptor() const override { return reader_.descriptor(); }
  [[nodiscard]] Traffic traffic() const override {
    Traffic traffic = traffic_;
    traffic.bytes = reader_.position();
    return traffic;
  }
  Status resume() override { return {}; }
  Result<std::vector<StreamInfo>> streams(bool) override { return streams_of(reader_.summary()); }
  Result<std::map<std::string, mcap::StringMap>> metadata() override { return reader_.metadata(); }

 private:
  /// Keeps a message that may have the elements of the next one on the topic of MTP. Both are in
  /// the same chunk, so those of other chunks, and their memory, are released.
  void keep(const std::string& topic, StoredMessage stored) {
    if (!beside_.empty() && beside_.begin()->second.owner != stored.owner) beside_.clear();
    beside_[topic] = std::move(stored);
  }

  /// The message of MTP, with the elements of the one beside it where they are there.
  Result<Message> rebuild(const StoredMessage& stored) {
    const auto& topic = stored.channel->topic;
    auto wrong = [&](const std::string& what) {
      return Error{Code::Malformed, "MCAP: " + topic + ": " + what};
    };
    auto matrix = ros::CdrReader::read<ros::Matrix>(stored.data);
    if (!matrix) return wrong(matrix.error().detail);
    auto header = parse_header(matrix->header, limits_);
    if (!header) return Error{header.error().code, "MCAP: " + topic + ": " + header.error().detail};
    auto elements = matrix->elements.bytes;
    auto owner = stored.owner;
    if (matrix->offset > 0) {
      const auto beside = beside_.find(topic);
      if (beside == beside_.end() || beside->second.record.sequence != stored.record.sequence)
        return wrong("message " + std::to_string(header->seq) + " lacks the one beside it");
      const auto data = beside->second.data;
      if (matrix->offset > data.size() || matrix->size > data.size() - matrix->offset)
        return wrong("elements reach over the end of the message beside");
      elements = data.subspan(matrix->offset, matrix->size);
      owner = beside->second.owner;
    }
    Message message{*header, elements, std::move(owner), 0};
    if (message.plain() && elements.size() != header->element_bytes())
      return wrong("there are " + std::to_string(elements.size()) + " bytes of elements, not " +
                   std::to_string(header->element_bytes()));
    const auto address = reinterpret_cast<std::uintptr_t>(elements.data());
    if (message.plain() && address % size_of(header->info.scalar) != 0) {
      const SharedBytes bytes = allocate_bytes(elements.size());
      std::ranges::copy(elements, bytes.get());
      message.elements = {bytes.get(), elements.size()};
      message.owner = bytes;
    }
    return message;
  }

  mcap::Reader reader_;
  const Limits limits_;
  Traffic traffic_;
  std::string stream_;  // of the last message
  std::int64_t log_time_ = 0;
  std::map<std::string, StoredMessage> beside_;  // the last, by the topic of MTP
};

}  // namespace

bool is_mtp(const StoredMessage& message) {
  return is_matrix(*message.channel, message.schema);
}

std::vector<StreamInfo> streams_of(const Summary& summary) {
  std::vector<StreamInfo> all;
  std::map<std::string_view, std::size_t> by_topic;
  for (const auto& [id, channel] : summary.channels) {
    if (!is_matrix(channel, schema_of(summary, channel))) continue;
    by_topic.emplace(channel.topic, all.size());  // others of this topic would only repeat it
    const auto count = summary.counts.find(id);
    all.push_back(
        {stream_name(channel), "", count != summary.counts.end() ? count->second : 0, 0, 0, {id}});
  }
  for (const auto& [id, channel] : summary.channels) {
    const auto* schema = schema_of(summary, channel);
    const auto beside = channel.metadata.find(kBesideKey);
    if (beside == channel.metadata.end() || is_matrix(channel, schema)) continue;
    const auto stream = by_topic.find(beside->second);
    if (stream == by_topic.end()) continue;
    auto& info = all[stream->second];
    info.channels.push_back(id);
    if (info.type.empty() && schema != nullptr) info.type = schema->name;
  }
  std::ranges::sort(all, {}, &StreamInfo::name);
  return all;
}

Result<std::unique_ptr<Reader>> read_mcap(const Place& place, const LinkOptions& options,
                                          bool all) {
  for (const auto& [key, value] : place.uri.options)
    if (key != "stream")
      return Error{Code::Invalid,
                   "a recording in MCAP has no option \"" + key + "\", only \"stream\""};
  mcap::ReaderLimits limits;
  limits.chunk_bytes = options.limits.element_bytes + (std::uint64_t{64} << 20);
  auto reader = mcap::Reader::open(place.path, limits);
  if (!reader) return reader.error();
  const auto& summary = reader->summary();
  // Of a file without its end, channels that only chunks declare may not be known yet.
  const auto known = streams_of(summary);
  if (!all && known.empty() && !summary.channels.empty() && summary.is_whole)
    return Error{Code::Unsupported, place.path + ": a recording of " +
                                        std::to_string(summary.channels.size()) +
                                        " topics, none of them made here"};
  const auto& wanted = place.stream;
  if (!wanted.empty() && std::ranges::find(known, wanted, &StreamInfo::name) == known.end()) {
    std::vector<std::string> names;
    for (const auto& each : known) names.push_back(each.name);
    return Error{Code::NotFound,
                 place.path + ": no stream \"" + wanted + "\"" + suggestion(wanted, names)};
  }
  if (!wanted.empty() || (!all && summary.is_whole)) {
    std::set<std::uint16_t> channels;
    for (const auto& each : known)
      if (wanted.empty() || each.name == wanted)
        channels.insert(each.channels.begin(), each.channels.end());
    reader->select(std::move(channels));
  }
  return std::unique_ptr<Reader>(new McapReader(std::move(*reader), options.limits));
}

}  // namespace hc::record
