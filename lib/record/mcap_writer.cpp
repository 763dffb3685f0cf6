// SPDX-License-Identifier: Apache-2.0
#include <record/mcap_writer.h>

#include <algorithm>
#include <array>

#include <hc/mtp/coords.h>
#include <ros/cdr.h>
#include <ros/messages.h>
#include <ros/type_for.h>

namespace hc::record {
namespace {

using mcap::StringMap;

/// Channel numbers have 16 bits. A message may need three new channels: two topics of its stream
/// and /tf; two are reserved for /tf_static and /rosout.
constexpr std::uint16_t kMostChannels = 65535 - 5;
constexpr std::string_view kStaticFrames = "/tf_static", kFrames = "/tf", kLog = "/rosout";
/// Suffix of the names of trace streams.
constexpr std::string_view kTrace = ".trace";
/// Age at which a chunk is written. Source: doc/recordings.md
constexpr std::chrono::milliseconds kChunkTime{500};
/// Limit on chunks waiting to be written. [byte]
constexpr std::size_t kBacklog = std::size_t{256} << 20;
/// The frame in which Rerun displays everything by default.
constexpr std::string_view kRerunOrigin = "tf#/";

/// A topic's quality of service for rosbag2: reliable, and transient local (1) or volatile (2).
std::string quality_of_service(bool is_kept) {
  const std::string forever = "    sec: 9223372036\n    nsec: 854775807\n";
  return "- history: 1\n  depth: 10\n  reliability: 1\n  durability: " +
         std::string(is_kept ? "1" : "2") + "\n  deadline:\n" + forever + "  lifespan:\n" +
         forever + "  liveliness: 1\n  liveliness_lease_duration:\n" + forever +
         "  avoid_ros_namespace_conventions: false\n";
}

/// The topic of a stream: `/MODULE/PORT`, with only letters, digits, _ and /.
std::string topic_of(std::string_view name) {
  std::string topic = "/";
  for (const char c : name) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    const char next = is_plain ? c : c == '.' || c == '/' ? '/' : '_';
    if (next != '/' || topic.back() != '/') topic += next;
  }
  if (topic.size() > 1 && topic.back() == '/') topic.pop_back();
  return topic == "/" ? "/stream" : topic;
}

Error no_room() {
  return {Code::TooLarge, "MCAP: a file can have " + std::to_string(kMostChannels) +
                              " topics, two for each stream; record fewer streams in one file"};
}

std::string key_of(const mcap::SchemaRecord& schema) {
  return schema.name + '\0' + schema.encoding + '\0' + schema.text;
}

mcap::SchemaRecord schema_of(ros::Type type) {
  const auto& schema = ros::schema(type);
  return {0, schema.name, "ros2msg", schema.text};
}

/// The child frames of a /tf_static message; as in tf2, a later message replaces each of them.
/// Empty if it cannot be read.
std::set<std::string> frames_of(std::span<const std::byte> message) {
  std::set<std::string> frames;
  if (const auto tf = ros::CdrReader::read<ros::TfMessage>(message))
    for (const auto& each : tf->transforms) frames.insert(each.child_frame_id);
  return frames;
}

std::vector<std::byte> joined(const ros::Pieces& data) {
  std::vector<std::byte> all;
  for (const auto piece : {data.head, data.body, data.tail})
    all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

std::uint64_t stamp(Time time) {
  return static_cast<std::uint64_t>(unix_nanoseconds(time));
}

}  // namespace

std::string take_name(std::set<std::string>& taken, const std::string& wanted) {
  std::string name = wanted;
  for (int i = 2; !taken.insert(name).second; ++i) name = wanted + "_" + std::to_string(i);
  return name;
}

Result<std::unique_ptr<McapWriter>> McapWriter::make(const std::string& file,
                                                     const WriterOptions& options) {
  auto joints = ros::GraphJoints::read(options.frames);
  if (!joints) return joints.error();
  auto storage = mcap::Storage::make(file, options);
  if (!storage) return storage.error();
  return std::unique_ptr<McapWriter>(
      new McapWriter(std::move(*storage), std::move(*joints), options.chunk_bytes));
}

McapWriter::McapWriter(mcap::Storage storage, ros::GraphJoints joints, std::size_t chunk_bytes)
    : chunk_bytes_(chunk_bytes),
      joints_(std::move(joints)),
      topics_{std::string(kFrames), std::string(kStaticFrames), std::string(kLog)},
      storage_(std::move(storage)),
      file_(storage_.file()) {
  encoder_.frames = joints_.names;
  thread_ = std::thread([this] { work(); });
}

McapWriter::~McapWriter() {
  static_cast<void>(close());
}

void McapWriter::add_stream(const std::string& name) {
  Stream stream;
  stream.name = take_name(names_, name);
  stream.topic = take_name(topics_, topic_of(name));
  stream.matrix_topic = take_name(topics_, stream.topic + "/mtp");
  stream.moves_frames = joints_.are_moved_by(name);
  stream.is_shown = !name.ends_with(kTrace);
  streams_.push_back(std::move(stream));
}

std::uint16_t McapWriter::add_channel(mcap::ChannelRecord channel, mcap::SchemaRecord schema) {
  if (!schema.name.empty()) {
    auto& number = schemas_[key_of(schema)];
    if (number == 0) {
      number = schema.id = static_cast<std::uint16_t>(schemas_.size());
      repeat(std::move(schema));
    }
    channel.schema = number;
  }
  channel.id = ++last_channel_;
  repeat(std::move(channel));
  return last_channel_;
}

std::uint16_t McapWriter::add_channel(const std::string& topic, ros::Type type,
                                      StringMap metadata) {
  metadata["offered_qos_profiles"] = quality_of_service(topic == kStaticFrames);
  return add_channel({0, 0, topic, "cdr", std::move(metadata)}, schema_of(type));
}

std::uint16_t McapWriter::channel(Stream& stream, ros::Type type) {
  auto& number = stream.channels[type];
  if (number != 0) return number;
  if (type == ros::Type::Matrix)
    return number = add_channel(stream.matrix_topic, type, {{kStreamKey, stream.name}});
  // A topic has one type; others, such as compressed images, get a topic below it.
  std::string topic = stream.topic;
  if (std::exchange(stream.has_topic, true))
    topic = take_name(topics_, topic + (type == ros::Type::CompressedImage
                                            ? "/compressed"
                                            : "/as_" + std::to_string(static_cast<int>(type))));
  return number = add_channel(topic, type, {{kCompanionKey, stream.matrix_topic}});
}

std::uint16_t McapWriter::other_channel(std::string_view topic, ros::Type type) {
  auto& number = other_channels_[{std::string(topic), "cdr" + key_of(schema_of(type))}];
  if (number == 0) number = add_channel(std::string(topic), type, {});
  return number;
}

std::uint16_t McapWriter::copied_channel(const mcap::StoredMessage& message, const void* from) {
  auto& number = copied_[message.channel];
  if (number != 0) return number;
  auto copy = *message.channel;
  const auto schema = message.schema != nullptr ? *message.schema : mcap::SchemaRecord();
  const auto stream = copy.metadata.find(kStreamKey);
  const auto companion = copy.metadata.find(kCompanionKey);
  auto topic_here = [&](const std::string& topic) {
    auto& here = copied_topics_[{from, topic}];
    if (here.empty()) here = take_name(topics_, topic);
    return here;
  };
  // Channels of streams, and of one file, stay separate; others of several files are merged if they
  // have the same topic and definition.
  if (stream == copy.metadata.end() && companion == copy.metadata.end()) {
    std::string key = copy.encoding + key_of(schema);
    if (const auto before = copied_counts_[{from, copy.topic + '\0' + key}]++; before > 0)
      key += '\0' + std::to_string(before);
    auto& other = other_channels_[{copy.topic, key}];
    if (other == 0) {
      const bool is_common =
          copy.topic == kStaticFrames || copy.topic == kFrames || copy.topic == kLog;
      if (!is_common) copy.topic = topic_here(copy.topic);
      other = add_channel(std::move(copy), schema);
    }
    return number = other;
  }
  copy.topic = topic_here(copy.topic);
  if (companion != copy.metadata.end()) companion->second = topic_here(companion->second);
  if (stream != copy.metadata.end()) stream->second = take_name(names_, stream->second);
  return number = add_channel(std::move(copy), schema);
}

void McapWriter::add(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time,
                     std::uint64_t publish_time, const ros::Pieces& data) {
  if (chunk_.empty()) chunk_begun_ = std::chrono::steady_clock::now();
  const std::array pieces = {data.head, data.body, data.tail};
  chunk_.add({channel, sequence, log_time, publish_time}, pieces);
}

void McapWriter::add_copy(const mcap::StoredMessage& message, const void* from) {
  const auto& record = message.record;
  add(copied_channel(message, from), record.sequence, record.log_time, record.publish_time,
      {{}, message.data, {}});
}

void McapWriter::copy_channel(const mcap::StoredMessage& message, const void* from) {
  const std::lock_guard lock(chunk_mutex_);
  if (last_channel_ < kMostChannels) copied_channel(message, from);
}

Status McapWriter::copy(const StoredPair& pair, const void* from) {
  const std::lock_guard lock(chunk_mutex_);
  const auto& [message, companion] = pair;
  const bool is_known =
      copied_.contains(message.channel) && (!companion || copied_.contains(companion->channel));
  if (!is_known && last_channel_ >= kMostChannels) return no_room();
  if (message.channel->topic == kStaticFrames) {
    repeat(mcap::Lasting{copied_channel(message, from),
                         message.record.sequence,
                         message.record.log_time,
                         {message.data.begin(), message.data.end()},
                         frames_of(message.data)},
           message.data.size());
    return wait_for_room();
  }
  if (companion) add_copy(*companion, from);
  add_copy(message, from);
  if (is_mtp(message)) ++chunk_.messages;
  flush_if_due();
  return wait_for_room();
}

Status McapWriter::write(std::size_t number, const Message& message, Time time) {
  const std::lock_guard lock(chunk_mutex_);
  if (!joints_.root.empty()) record_fixed_frames(time);
  const Header& header = message.header;
  Stream& stream = streams_[number];
  const auto sequence = static_cast<std::uint32_t>(header.seq);
  const Time published = header.time != Time() ? header.time : time;
  const bool is_picture =
      header.info.type == MatrixType::RgbImage || header.info.type == MatrixType::IntensityImage;
  // The size for CameraInfo: that of rectified images, or of any image until one arrives.
  if (is_picture && (header.coord == Coord::kLeftRectified || encoder_.camera_width == 0)) {
    encoder_.camera_width = static_cast<std::uint32_t>(header.width);
    encoder_.camera_height = static_cast<std::uint32_t>(header.height);
  }
  // The type is that of the first message; images may additionally be compressed.
  auto type = stream.is_shown ? ros::type_for(header) : std::nullopt;
  if (type && type != ros::Type::CompressedImage) {
    if (!stream.type) stream.type = type;
    type = stream.type;
  }
  const bool has_channels =
      stream.channels.contains(ros::Type::Matrix) && (!type || stream.channels.contains(*type));
  if (!has_channels && last_channel_ >= kMostChannels) return no_room();
  std::uint32_t offset = 0;
  if (type) {
    if (auto data = encoder_.encode(*type, message)) {
      add(channel(stream, *type), sequence, stamp(time), stamp(published), *data);
      if (!data->body.empty() && data->body.data() == message.elements.data())
        offset = static_cast<std::uint32_t>(data->head.size());
    }
  }
  add(channel(stream, ros::Type::Matrix), sequence, stamp(time), stamp(published),
      matrix_encoder_.encode_matrix(message, offset));
  ++chunk_.messages;
  if (stream.moves_frames) {
    if (auto joint = joints_.joint_of(message)) {
      joint->time = published;
      add_other(kFrames, ros::Type::TfMessage, time, encoder_.encode(std::span(&*joint, 1)));
    }
  }
  flush_if_due();
  return wait_for_room();
}

void McapWriter::add_other(std::string_view topic, ros::Type type, Time time,
                           const ros::Pieces& data) {
  add(other_channel(topic, type), ++others_, stamp(time), stamp(time), data);
}

Status McapWriter::log(Time time, const LogLine& line) {
  const std::lock_guard lock(chunk_mutex_);
  add_other(kLog, ros::Type::Log, time, encoder_.encode_log(time, line));
  flush_if_due();
  return wait_for_room();
}

/// Records the fixed frames, with the time of the first message.
void McapWriter::record_fixed_frames(Time time) {
  auto fixed = std::move(joints_.fixed);
  fixed.push_back({.parent = std::string(kRerunOrigin), .child = joints_.root, .time = time});
  joints_.root.clear();
  for (auto& joint : fixed) joint.time = time;
  const auto number = other_channel(kStaticFrames, ros::Type::TfMessage);
  auto data = joined(encoder_.encode(fixed));
  auto frames = frames_of(data);
  repeat(mcap::Lasting{number, ++others_, stamp(time), std::move(data), std::move(frames)});
}

Status McapWriter::metadata(const std::string& name, const StringMap& words) {
  repeat(mcap::MetadataRecord{name, words});
  return wait_for_room();
}

void McapWriter::repeat(mcap::Storage::Repeated record, std::size_t bytes) {
  enqueue({[this, record = std::move(record)] { return storage_.add(record); }, bytes});
}

Status McapWriter::wait_for_room() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_ <= kBacklog; });
  return status_;
}

void McapWriter::flush_if_due() {
  if (chunk_.size() >= chunk_bytes_ ||
      std::chrono::steady_clock::now() - chunk_begun_ >= kChunkTime)
    flush();
}

void McapWriter::flush() {
  if (chunk_.empty()) return;
  const auto bytes = chunk_.size();
  const auto messages = chunk_.messages;
  auto write = [this, chunk = std::exchange(chunk_, {})] { return storage_.add(chunk.pack()); };
  enqueue({std::move(write), bytes, messages});
}

void McapWriter::enqueue(Job job) {
  const std::lock_guard lock(mutex_);
  waiting_ += job.bytes;
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

Result<std::string> McapWriter::save() {
  if (is_closed_) return status_ ? Error{Code::Closed, "the recording has ended"} : status_.error();
  const std::lock_guard chunk(chunk_mutex_);
  flush();
  Result<std::string> saved = Error{};
  enqueue({[&] {
    saved = storage_.save();
    return Status();
  }});
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return jobs_.empty(); });
  return status_ ? std::move(saved) : status_.error();
}

Status McapWriter::close() {
  if (!std::exchange(is_closed_, true)) {
    const std::lock_guard chunk(chunk_mutex_);
    flush();
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
      changed_.notify_all();
    }
    thread_.join();
    auto closed = storage_.close();
    if (status_) status_ = closed;
  }
  return status_;
}

void McapWriter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    if (!changed_.wait_for(lock, kChunkTime / 2, [&] { return is_ending_ || !jobs_.empty(); })) {
      lock.unlock();
      // A call that holds the chunk flushes it itself.
      if (const std::unique_lock chunk(chunk_mutex_, std::try_to_lock); chunk) flush_if_due();
      lock.lock();
      continue;
    }
    if (jobs_.empty()) return;
    const Job& job = jobs_.front();
    if (status_) {
      lock.unlock();
      auto done = job.work();
      lock.lock();
      status_ = done;
    }
    if (!status_) lost_ += job.messages;
    waiting_ -= job.bytes;
    jobs_.pop_front();
    changed_.notify_all();
  }
}

}  // namespace hc::record
