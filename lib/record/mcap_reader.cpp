// SPDX-License-Identifier: Apache-2.0
// Streams of MTP in MCAP files (doc/recordings.md, "In the file").
#include <algorithm>
#include <deque>
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

/// MCAP has times until 2554.
Time time_of(std::uint64_t nanoseconds) {
  return unix_time(static_cast<std::int64_t>(
      std::min<std::uint64_t>(nanoseconds, std::numeric_limits<std::int64_t>::max())));
}

/// The MTP topic of a message or of its companion; empty: it is neither.
std::string_view pair_topic(const StoredMessage& stored) {
  if (is_mtp(stored)) return stored.channel->topic;
  const auto topic = stored.channel->metadata.find(kCompanionKey);
  return topic != stored.channel->metadata.end() ? std::string_view(topic->second) : "";
}

/// Whether the elements of an MTP message are stored in its companion.
bool lacks_elements(const StoredMessage& stored) {
  const auto matrix = ros::CdrReader::read<ros::Matrix>(stored.data);
  return matrix && matrix->offset > 0;
}

class McapReader final : public Reader {
 public:
  /// @param most_ahead  limit on chunks held while searching for a companion. [byte]
  McapReader(mcap::Reader reader, const Limits& limits, std::uint64_t most_ahead, Topics topics)
      : reader_(std::move(reader)), limits_(limits), most_ahead_(most_ahead), topics_(topics) {}

  Result<Got> take(Message& message) override {
    message = {};
    const auto stored = HC_TRY(take_stored());
    if (!stored) return Got::End;
    message = HC_TRY(rebuild(*stored));
    stream_ = stream_name(*stored->message.channel);
    log_time_ = time_of(stored->message.record.log_time);
    ++traffic_.messages;
    return Got::Message;
  }

  Result<std::optional<StoredPair>> take_stored() override {
    HC_TRY(next_time());
    return std::exchange(ahead_, std::nullopt);
  }
  Result<std::optional<Time>> next_time() override {
    while (!ahead_) {
      ahead_ = HC_TRY(read_pair());
      if (!ahead_) return std::optional<Time>();
      if (topics_ == Topics::Mtp && !is_mtp(ahead_->message)) ahead_.reset();
    }
    return std::optional(time_of(ahead_->message.record.log_time));
  }

  [[nodiscard]] Time log_time() const override { return log_time_; }
  [[nodiscard]] std::string_view stream() const override { return stream_; }
  void start_at(Time log_time) override {
    reader_.start_at(static_cast<std::uint64_t>(unix_nanoseconds(log_time)));
    std::erase_if(queue_, [&](const StoredMessage& each) {
      return time_of(each.record.log_time) < log_time;
    });
    if (ahead_ && time_of(ahead_->message.record.log_time) < log_time) ahead_.reset();
  }
  [[nodiscard]] int descriptor() const override { return reader_.descriptor(); }
  [[nodiscard]] Traffic traffic() const override {
    Traffic traffic = traffic_;
    traffic.bytes = reader_.position();
    return traffic;
  }
  Status resume() override { return {}; }
  Result<std::vector<StreamInfo>> streams(StreamDetail) override {
    return streams_of(reader_.summary());
  }
  Result<std::vector<mcap::MetadataRecord>> metadata() override { return reader_.metadata(); }
  [[nodiscard]] std::string profile() const override { return reader_.summary().profile; }
  void for_each_channel(const TakeChannel& take) const override {
    const auto& summary = reader_.summary();
    for (const auto& [id, channel] : summary.channels)
      if (reader_.is_selected(id))
        take({{}, &channel, schema_of(summary, channel), {}, nullptr}, *this);
  }

 private:
  /// The next message and its companion, in either order; a companion without a message is returned
  /// as the message. nullopt at the end.
  Result<std::optional<StoredPair>> read_pair() {
    if (!HC_TRY(read_ahead(0))) return std::optional<StoredPair>();
    StoredPair pair{std::move(queue_.front()), std::nullopt};
    queue_.pop_front();
    pair.companion = find_counterpart(pair.message);
    if (pair.companion && is_mtp(*pair.companion)) std::swap(pair.message, *pair.companion);
    return std::optional(std::move(pair));
  }

  /// Reads ahead until the queue has a message at `place`; false at the end.
  Result<bool> read_ahead(std::size_t place) {
    if (place < queue_.size()) return true;
    if (failed_) return *std::exchange(failed_, std::nullopt);
    auto stored = HC_TRY(reader_.next());
    if (stored) queue_.push_back(std::move(*stored));
    return stored.has_value();
  }

  /// Takes the companion of a message, or the message of a companion, from those with the same log
  /// time, within the limits.
  std::optional<StoredMessage> find_counterpart(const StoredMessage& one) {
    constexpr std::size_t kMost = 1000;
    const auto topic = pair_topic(one);
    const bool is_alone = topic.empty() || (is_mtp(one) && !lacks_elements(one));
    const void* owner = one.owner.get();
    std::uint64_t owned = one.owned;
    for (std::size_t i = 0; i < kMost && !is_alone && owned <= most_ahead_; ++i) {
      if (i == queue_.size()) {
        if (failed_) break;
        const auto time = reader_.next_time();
        if (!time) failed_ = time.error();
        if (!time || *time != one.record.log_time) break;
        auto read = read_ahead(i);
        if (!read) failed_ = read.error();
        if (!read || !*read) break;
      }
      const auto& each = queue_[i];
      const auto& [channel, sequence, log_time, publish_time] = each.record;
      if (log_time != one.record.log_time) break;
      if (std::exchange(owner, each.owner.get()) != each.owner.get()) owned += each.owned;
      if (sequence != one.record.sequence || is_mtp(each) == is_mtp(one) ||
          pair_topic(each) != topic)
        continue;
      auto other = std::move(queue_[i]);
      queue_.erase(queue_.begin() + static_cast<std::ptrdiff_t>(i));
      return other;
    }
    return std::nullopt;
  }

  /// The MTP message, with its companion's elements if it has none.
  Result<Message> rebuild(const StoredPair& pair) {
    const auto& stored = pair.message;
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
      if (!pair.companion)
        return wrong("message " + std::to_string(header->seq) +
                     " has no companion message, which has its elements");
      const auto data = pair.companion->data;
      if (matrix->offset > data.size() || matrix->size > data.size() - matrix->offset)
        return wrong("elements extend beyond the companion message");
      elements = data.subspan(matrix->offset, matrix->size);
      owner = pair.companion->owner;
    }
    Message message{*header, elements, std::move(owner), 0};
    if (message.plain() && elements.size() != header->element_bytes())
      return wrong("expected " + std::to_string(header->element_bytes()) +
                   " bytes of elements, got " + std::to_string(elements.size()));
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
  const std::uint64_t most_ahead_;
  const Topics topics_;
  Traffic traffic_;
  std::string stream_;  // of the last message
  Time log_time_;
  std::optional<StoredPair> ahead_;
  std::deque<StoredMessage> queue_;  // read ahead, by log time
  std::optional<Error> failed_;      // the error after them
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
    by_topic.emplace(channel.topic, all.size());  // further channels of a topic are copies
    const auto count = summary.counts.find(id);
    const auto messages = count != summary.counts.end() ? count->second : 0;
    all.push_back({stream_name(channel), "", messages, {}, {}, {id}});
  }
  for (const auto& [id, channel] : summary.channels) {
    const auto* schema = schema_of(summary, channel);
    const auto topic = channel.metadata.find(kCompanionKey);
    if (topic == channel.metadata.end() || is_matrix(channel, schema)) continue;
    const auto stream = by_topic.find(topic->second);
    if (stream == by_topic.end()) continue;
    auto& info = all[stream->second];
    info.channels.push_back(id);
    if (info.type.empty() && schema != nullptr) info.type = schema->name;
  }
  std::ranges::sort(all, {}, &StreamInfo::name);
  return all;
}

Result<std::unique_ptr<Reader>> read_mcap(const Place& place, const LinkOptions& options,
                                          Topics topics) {
  for (const auto& [key, value] : place.uri.options)
    if (key != "stream")
      return Error{Code::Invalid,
                   "a recording in MCAP has no option \"" + key + R"(", only "stream")"};
  mcap::ReaderLimits limits;
  limits.chunk_bytes = options.limits.element_bytes + (std::uint64_t{64} << 20);
  auto reader = mcap::Reader::open(place.path, limits);
  if (!reader) return reader.error();
  const auto& summary = reader->summary();
  // In a truncated file, channels declared only in chunks may not be known yet.
  const auto known = streams_of(summary);
  const bool all = topics == Topics::All;
  if (!all && known.empty() && !summary.channels.empty() && summary.is_whole)
    return Error{Code::Unsupported, place.path + ": a recording of " +
                                        std::to_string(summary.channels.size()) +
                                        " topics, none of them MTP"};
  const auto& wanted = place.stream;
  if (!wanted.empty() && std::ranges::find(known, wanted, &StreamInfo::name) == known.end()) {
    std::vector<std::string> names;
    names.reserve(known.size());
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
  return std::unique_ptr<Reader>(
      new McapReader(std::move(*reader), options.limits, limits.chunk_bytes, topics));
}

}  // namespace hc::record
