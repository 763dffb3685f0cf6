// SPDX-License-Identifier: Apache-2.0
#include <mcap/link.h>

#include <algorithm>
#include <chrono>
#include <map>

#include <hc/base/suggestion.h>
#include <mcap/recorder.h>
#include <ros/messages.h>
#include <ros/schema.h>

namespace hc::mcap {
namespace {

/// Metadata of channels: the stream of one for messages of MTP; and beside which one another is.
constexpr const char* kStream = "hypercolumn.stream";
constexpr const char* kBeside = "hypercolumn.mtp";

bool is_matrix(const Summary& summary, const ChannelRecord& channel) {
  const auto schema = summary.schemas.find(channel.schema);
  return channel.encoding == "cdr" && schema != summary.schemas.end() &&
         schema->second.name == ros::schema(ros::Type::Matrix).name;
}

std::string stream_name(const ChannelRecord& channel) {
  const auto name = channel.metadata.find(kStream);
  return name != channel.metadata.end() ? name->second : channel.topic;
}

/// The channels that are beside one of MTP, by the topic of that; none is of MTP itself.
std::multimap<std::string_view, std::uint16_t> channels_beside(const Summary& summary) {
  std::multimap<std::string_view, std::uint16_t> channels;
  for (const auto& [id, channel] : summary.channels)
    if (const auto beside = channel.metadata.find(kBeside);
        beside != channel.metadata.end() && !is_matrix(summary, channel))
      channels.emplace(beside->second, id);
  return channels;
}

class RecordingSource : public Source {
 public:
  RecordingSource(Reader reader, const Limits& limits)
      : reader_(std::move(reader)), limits_(limits) {}

  Result<Got> take(Message& message) override {
    message = {};
    while (true) {
      auto stored = reader_.next();
      if (!stored) return stored.error();
      if (!*stored) return Got::End;
      const auto channel = reader_.found.channels.find((*stored)->record.channel);
      if (channel == reader_.found.channels.end())
        return Error{Code::Malformed, "MCAP: a message of channel " +
                                          std::to_string((*stored)->record.channel) +
                                          ", which is not declared"};
      if (!is_matrix(reader_.found, channel->second)) {
        const auto beside = channel->second.metadata.find(kBeside);
        if (beside != channel->second.metadata.end()) keep(beside->second, std::move(**stored));
        continue;
      }
      auto made = rebuild(**stored, channel->second.topic);
      if (!made) return made.error();
      message = std::move(*made);
      stream_ = stream_name(channel->second);
      ++traffic_.messages;
      traffic_.bytes = reader_.position();
      return Got::Message;
    }
  }

  [[nodiscard]] int descriptor() const override { return reader_.descriptor(); }
  [[nodiscard]] Traffic traffic() const override { return traffic_; }
  Status resume() override { return {}; }
  [[nodiscard]] std::string_view stream() const { return stream_; }

 private:
  /// Keeps what the next message of a topic may need; of one chunk, since that is its memory.
  void keep(const std::string& topic, StoredMessage stored) {
    if (!beside_.empty() && beside_.begin()->second.owner != stored.owner) beside_.clear();
    beside_[topic] = std::move(stored);
  }

  /// The message of MTP out of the two that stand for it.
  Result<Message> rebuild(const StoredMessage& stored, const std::string& topic) {
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

  Reader reader_;
  Limits limits_;
  Traffic traffic_;
  std::string stream_;                           // of the last message
  std::map<std::string, StoredMessage> beside_;  // the last, by the topic of MTP
};

class RecordingSink : public Sink {
 public:
  explicit RecordingSink(std::unique_ptr<Recorder> recorder) : recorder_(std::move(recorder)) {}

  Status send(const Message& message) override {
    const auto src = message.header.src;
    auto known = streams_.find(src);
    if (known == streams_.end())
      known = streams_.emplace(src, recorder_->add_stream("src_" + std::to_string(src))).first;
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    traffic_.messages += 1;
    traffic_.bytes += message.elements.size();
    return recorder_->record(known->second, message,
                             std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
  }
  Status close() override { return recorder_->close(); }
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

 private:
  std::unique_ptr<Recorder> recorder_;
  std::map<std::int32_t, std::size_t> streams_;
  Traffic traffic_;
};

/// Options other than these are refused.
Status check_options(const Uri& uri, std::string_view known) {
  for (const auto& [key, value] : uri.options)
    if (key != known)
      return Error{Code::Invalid,
                   "a recording in MCAP has no option \"" + key + "\"" +
                       (known.empty() ? "" : ", only \"" + std::string(known) + "\"")};
  return {};
}

}  // namespace

std::optional<Uri> recording_uri(std::string_view text) {
  auto uri = parse_uri(text);
  if (!uri || uri->scheme != "file" || !uri->rest.ends_with(".mcap")) return std::nullopt;
  return *uri;
}

std::vector<StreamInfo> streams(const Summary& summary) {
  std::vector<StreamInfo> all;
  auto besides = channels_beside(summary);
  for (const auto& [id, channel] : summary.channels) {
    if (!is_matrix(summary, channel)) continue;
    StreamInfo stream{stream_name(channel), "", "", {channel.topic}, 0};
    if (const auto count = summary.counts.find(id); count != summary.counts.end())
      stream.messages = count->second;
    const auto [begin, end] = besides.equal_range(channel.topic);
    for (auto beside = begin; beside != end; ++beside) {
      const auto& other = summary.channels.at(beside->second);
      const auto schema = summary.schemas.find(other.schema);
      stream.topics.push_back(other.topic);
      if (!stream.topic.empty()) continue;
      stream.topic = other.topic;
      if (schema != summary.schemas.end()) stream.type = schema->second.name;
    }
    besides.erase(begin, end);  // others of this topic would only repeat them
    all.push_back(std::move(stream));
  }
  std::ranges::sort(all, {}, &StreamInfo::name);
  return all;
}

Result<std::unique_ptr<Source>> read_recording(const Uri& uri, const LinkOptions& options) {
  if (auto checked = check_options(uri, "stream"); !checked) return checked.error();
  ReaderLimits limits;
  limits.chunk_bytes = options.limits.element_bytes + (std::uint64_t{64} << 20);
  auto reader = Reader::open(uri.rest, limits);
  if (!reader) return reader.error();
  auto summary = reader->summary();
  if (!summary) return summary.error();
  // Of a file without its end, channels that only chunks declare are not known yet.
  const auto known = streams(*summary);
  const bool has_other = !summary->channels.empty() && known.empty();
  if (has_other && summary->is_whole)
    return Error{Code::Unsupported, uri.rest + ": a recording of " +
                                        std::to_string(summary->channels.size()) +
                                        " topics, none of them made here"};
  if (const auto wanted = uri.option("stream", ""); !wanted.empty()) {
    std::vector<std::string> names;
    names.reserve(known.size());
    for (const auto& each : known) names.push_back(each.name);
    if (std::ranges::find(names, wanted) == names.end())
      return Error{Code::NotFound, uri.rest + ": no stream \"" + std::string(wanted) + "\"" +
                                       suggestion(wanted, names)};
    std::set<std::uint16_t> channels;
    auto besides = channels_beside(*summary);
    for (const auto& [id, channel] : summary->channels) {
      if (!is_matrix(*summary, channel) || stream_name(channel) != wanted) continue;
      channels.insert(id);
      const auto [begin, end] = besides.equal_range(channel.topic);
      for (auto beside = begin; beside != end; ++beside) channels.insert(beside->second);
      besides.erase(begin, end);
    }
    reader->select(std::move(channels));
  }
  // What the summary says of schemas and channels holds wherever they are first declared.
  reader->found.schemas = summary->schemas;
  reader->found.channels = summary->channels;
  return std::unique_ptr<Source>(new RecordingSource(std::move(*reader), options.limits));
}

std::string_view stream_of(const Source& source) {
  const auto* recording = dynamic_cast<const RecordingSource*>(&source);
  return recording != nullptr ? recording->stream() : std::string_view();
}

Result<std::unique_ptr<Sink>> write_recording(const Uri& uri, const LinkOptions& link) {
  if (auto checked = check_options(uri, ""); !checked) return checked.error();
  RecorderOptions options;
  options.file = uri.rest;
  auto recorder = Recorder::make(options);
  if (!recorder) return recorder.error();
  if ((*recorder)->file() != uri.rest && link.log)
    link.log(Level::Warning,
             uri.text() + ": the file stays as it is; continuing in " + (*recorder)->file());
  return std::unique_ptr<Sink>(new RecordingSink(std::move(*recorder)));
}

}  // namespace hc::mcap
