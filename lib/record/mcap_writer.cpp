// SPDX-License-Identifier: Apache-2.0
#include <record/mcap_writer.h>

#include <algorithm>
#include <array>

#include <hc/mtp/coords.h>

namespace hc::record {
namespace {

using mcap::Words;

/// Channels have numbers of 16 bits. A message takes up to three new ones: of its stream's two
/// topics, and /tf; /tf_static and /rosout are two more.
constexpr std::uint16_t kMostChannels = 65535 - 5;
constexpr std::string_view kStaticFrames = "/tf_static", kFrames = "/tf", kLog = "/rosout";
/// How streams end that are of a module's output `trace`.
constexpr std::string_view kTrace = ".trace";
/// The frame in which Rerun shows things, unless somebody chooses another one.
constexpr std::string_view kRerunOrigin = "tf#/";

/// What rosbag2 wants to know of a topic: reliable, and volatile (2) or kept for who comes late
/// (1).
std::string quality_of_service(bool is_kept) {
  const std::string forever = "    sec: 9223372036\n    nsec: 854775807\n";
  return "- history: 1\n  depth: 10\n  reliability: 1\n  durability: " +
         std::string(is_kept ? "1" : "2") + "\n  deadline:\n" + forever + "  lifespan:\n" +
         forever + "  liveliness: 1\n  liveliness_lease_duration:\n" + forever +
         "  avoid_ros_namespace_conventions: false\n";
}

/// A topic of a name: `/MODULE/PORT`, of letters, digits, _ and / alone.
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
  return {Code::TooLarge, "MCAP: a file has room for " + std::to_string(kMostChannels) +
                              " topics, two for each stream; record fewer streams in one file"};
}

std::array<std::span<const std::byte>, 3> pieces_of(const ros::Pieces& data) {
  return {data.head, data.body, data.tail};
}

}  // namespace

Result<std::unique_ptr<Format>> McapWriter::make(const FormatOptions& options) {
  auto joints = ros::GraphJoints::read(options.frames);
  if (!joints) return joints.error();
  auto storage = mcap::Storage::make(options);
  if (!storage) return storage.error();
  return std::unique_ptr<Format>(new McapWriter(options, std::move(*storage), std::move(*joints)));
}

Result<std::unique_ptr<Format>> open_mcap(const FormatOptions& options) {
  return McapWriter::make(options);
}

McapWriter::McapWriter(FormatOptions options, mcap::Storage storage, ros::GraphJoints joints)
    : options_(std::move(options)),
      joints_(std::move(joints)),
      topics_{std::string(kFrames), std::string(kStaticFrames), std::string(kLog)},
      storage_(std::move(storage)) {
  options_.file = storage_.file();
  encoder_.frames = joints_.names;
  thread_ = std::thread([this] { work(); });
}

McapWriter::~McapWriter() {
  static_cast<void>(close());
}

Status McapWriter::add_stream(const std::string& name) {
  Stream stream;
  stream.name = take_name(names_, name);
  stream.topic = take_name(topics_, topic_of(name));
  stream.matrix_topic = take_name(topics_, stream.topic + "/mtp");
  stream.moves_frames = joints_.are_moved_by(name);
  stream.is_shown = !name.ends_with(kTrace);
  streams_.push_back(std::move(stream));
  return {};
}

std::uint16_t McapWriter::add_channel(mcap::ChannelRecord channel, mcap::SchemaRecord schema) {
  if (!schema.name.empty()) {
    auto& number = schemas_[schema.name + '\0' + schema.encoding + '\0' + schema.text];
    if (number == 0) {
      number = schema.id = static_cast<std::uint16_t>(schemas_.size());
      next_.schemas.push_back(std::move(schema));
    }
    channel.schema = number;
  }
  channel.id = ++last_channel_;
  next_.channels.push_back(std::move(channel));
  return last_channel_;
}

std::uint16_t McapWriter::channel(const std::string& topic, ros::Type type, Words metadata) {
  const auto& schema = ros::schema(type);
  metadata["offered_qos_profiles"] = quality_of_service(topic == kStaticFrames);
  return add_channel({0, 0, topic, "cdr", std::move(metadata)},
                     {0, schema.name, "ros2msg", schema.text});
}

std::uint16_t McapWriter::channel(Stream& stream, ros::Type type) {
  auto& number = stream.channels[type];
  if (number != 0) return number;
  if (stream.matrix == 0)
    stream.matrix =
        channel(stream.matrix_topic, ros::Type::Matrix, {{mcap::kStreamKey, stream.name}});
  // A topic has one type. What comes beside the first is rare: an image that is compressed.
  if (type == ros::Type::Matrix) return number = stream.matrix;
  std::string topic = stream.topic;
  if (std::exchange(stream.has_topic, true))
    topic = take_name(topics_, topic + (type == ros::Type::CompressedImage
                                            ? "/compressed"
                                            : "/as_" + std::to_string(static_cast<int>(type))));
  return number = channel(topic, type, {{mcap::kBesideKey, stream.matrix_topic}});
}

void McapWriter::add(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time,
                     std::int64_t publish_time, std::span<const std::span<const std::byte>> data) {
  if (chunk_.empty()) chunk_begun_ = std::chrono::steady_clock::now();
  chunk_.add({channel, sequence, static_cast<std::uint64_t>(log_time),
              static_cast<std::uint64_t>(publish_time)},
             data);
}

std::uint16_t McapWriter::channel(const Stored& stored) {
  auto& number = copied_[{stored.file, stored.channel->id}];
  if (number != 0) return number;
  if (last_channel_ >= kMostChannels) return 0;
  auto copy = *stored.channel;
  const auto schema = stored.schema != nullptr ? *stored.schema : mcap::SchemaRecord();
  const auto stream = copy.metadata.find(mcap::kStreamKey);
  const auto beside = copy.metadata.find(mcap::kBesideKey);
  auto topic_here = [&](const std::string& topic) {
    auto& here = copied_topics_[{stored.file, topic}];
    if (here.empty()) here = take_name(topics_, topic);
    return here;
  };
  // Topics of streams are theirs alone. All others that have the same name and type are one.
  if (stream == copy.metadata.end() && beside == copy.metadata.end()) {
    auto& other = other_channels_[{copy.topic, schema.name}];
    if (other == 0) {
      const bool is_common =
          copy.topic == kStaticFrames || copy.topic == kFrames || copy.topic == kLog;
      if (!is_common) copy.topic = take_name(topics_, copy.topic);
      other = add_channel(std::move(copy), schema);
    }
    return number = other;
  }
  copy.topic = topic_here(copy.topic);
  if (beside != copy.metadata.end()) beside->second = topic_here(beside->second);
  if (stream != copy.metadata.end()) stream->second = take_name(names_, stream->second);
  return number = add_channel(std::move(copy), schema);
}

Status McapWriter::write(const Stored& stored) {
  const auto number = channel(stored);
  if (number == 0) return no_room();
  const auto& message = stored.message.record;
  const std::span<const std::byte> pieces[] = {stored.message.data};
  if (stored.channel->topic == kStaticFrames) {
    next_.lasting.push_back({number,
                             message.sequence,
                             message.log_time,
                             {stored.message.data.begin(), stored.message.data.end()}});
    return {};
  }
  add(number, message.sequence, static_cast<std::int64_t>(message.log_time),
      static_cast<std::int64_t>(message.publish_time), pieces);
  if (stored.is_mtp) ++chunk_.messages;
  // What stands beside a message of MTP is in the same chunk.
  if (stored.channel->metadata.contains(mcap::kBesideKey)) return {};
  return hand_on_if_due();
}

Status McapWriter::write(std::size_t number, const Message& message, std::int64_t time) {
  if (!joints_.root.empty()) record_fixed_frames(time);
  const Header& header = message.header;
  Stream& stream = streams_[number];
  const auto sequence = static_cast<std::uint32_t>(header.seq);
  const std::int64_t published = header.time != 0 ? header.time : time;
  const bool is_picture =
      header.info.type == MatrixType::RgbImage || header.info.type == MatrixType::IntensityImage;
  // Until a rectified image has come, they are as large as another one.
  if (is_picture && (header.coord == Coord::kLeftRectified || encoder_.camera_width == 0)) {
    encoder_.camera_width = static_cast<std::uint32_t>(header.width);
    encoder_.camera_height = static_cast<std::uint32_t>(header.height);
  }
  // The type is that of the first message, but for images, which are compressed or not.
  auto type = stream.is_shown ? ros::type_for(header) : std::nullopt;
  if (type && type != ros::Type::CompressedImage) {
    if (!stream.type) stream.type = type;
    type = stream.type;
  }
  const bool has_channels = stream.matrix != 0 && (!type || stream.channels.contains(*type));
  if (!has_channels && last_channel_ >= kMostChannels) return no_room();
  std::uint32_t offset = 0;
  if (type) {
    if (auto data = encoder_.encode(*type, message)) {
      add(channel(stream, *type), sequence, time, published, pieces_of(*data));
      if (!data->body.empty() && data->body.data() == message.elements.data())
        offset = static_cast<std::uint32_t>(data->head.size());
    }
  }
  add(channel(stream, ros::Type::Matrix), sequence, time, published,
      pieces_of(matrix_encoder_.encode_matrix(message, offset)));
  ++chunk_.messages;
  if (stream.moves_frames) {
    if (auto joint = joints_.joint_of(message)) {
      joint->time = published;
      add_other(kFrames, ros::Type::TfMessage, time, encoder_.encode(std::span(&*joint, 1)));
    }
  }
  return hand_on_if_due();
}

std::uint16_t McapWriter::other_channel(std::string_view topic, ros::Type type) {
  auto& number = other_channels_[{std::string(topic), ros::schema(type).name}];
  if (number == 0) number = channel(std::string(topic), type, {});
  return number;
}

void McapWriter::add_other(std::string_view topic, ros::Type type, std::int64_t time,
                           const ros::Pieces& data) {
  add(other_channel(topic, type), ++others_, time, time, pieces_of(data));
}

Status McapWriter::log(std::int64_t time, const LogLine& line) {
  add_other(kLog, ros::Type::Log, time, encoder_.encode_log(time, line));
  return hand_on_if_due();
}

/// What never moves is in each file, and is said as the first message comes.
void McapWriter::record_fixed_frames(std::int64_t time) {
  auto fixed = std::move(joints_.fixed);
  fixed.push_back({.parent = std::string(kRerunOrigin), .child = joints_.root, .time = time});
  joints_.root.clear();
  for (auto& joint : fixed) joint.time = time;
  const auto number = other_channel(kStaticFrames, ros::Type::TfMessage);
  mcap::Lasting lasting{number, ++others_, static_cast<std::uint64_t>(time), {}};
  const auto data = encoder_.encode(fixed);
  for (const auto piece : pieces_of(data))
    lasting.data.insert(lasting.data.end(), piece.begin(), piece.end());
  next_.lasting.push_back(std::move(lasting));
}

Status McapWriter::metadata(const std::string& name, const Words& words) {
  Job job;
  job.metadata.push_back({name, words});
  return enqueue(std::move(job));
}

Status McapWriter::hand_on_if_due() {
  if (chunk_.size() >= options_.chunk_bytes) return hand_on();
  return poll();
}

Status McapWriter::poll() {
  if (!chunk_.empty() && std::chrono::steady_clock::now() - chunk_begun_ >= options_.chunk_time)
    return hand_on();
  const std::lock_guard lock(mutex_);
  return status_;
}

Status McapWriter::hand_on() {
  Job job = std::exchange(next_, {});
  if (!chunk_.empty()) job.chunk = std::exchange(chunk_, {});
  return enqueue(std::move(job));
}

Status McapWriter::enqueue(Job job) {
  std::unique_lock lock(mutex_);
  const std::size_t size = job.chunk ? job.chunk->size() : 0;
  changed_.wait(lock, [&] { return waiting_ == 0 || waiting_ + size <= options_.backlog; });
  waiting_ += size;
  jobs_.push_back(std::move(job));
  changed_.notify_all();
  return status_;
}

Result<std::string> McapWriter::save() {
  if (auto handed = hand_on(); !handed) return handed.error();
  Job job;
  job.saves = true;
  if (auto queued = enqueue(std::move(job)); !queued) return queued.error();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return saved_.has_value(); });
  auto saved = std::move(*saved_);
  saved_.reset();
  return saved;
}

Status McapWriter::close() {
  if (!std::exchange(is_closed_, true)) {
    static_cast<void>(hand_on());
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
      changed_.notify_all();
    }
    thread_.join();
    auto closed = storage_.close();
    if (status_ && !closed) status_ = closed;
  }
  return status_;
}

void McapWriter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_ending_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    const std::size_t size = job.chunk ? job.chunk->size() : 0;
    if (status_) {
      lock.unlock();
      auto done = perform(job);
      std::optional<Result<std::string>> saved;
      if (job.saves) saved = storage_.save();
      lock.lock();
      if (saved) saved_ = std::move(saved);
      if (!done) status_ = done;
    } else {
      if (job.chunk) discarded_ += job.chunk->messages;
      if (job.saves) saved_ = status_.error();
    }
    waiting_ -= size;
    changed_.notify_all();
  }
}

Status McapWriter::perform(Job& job) {
  Status done;
  for (auto& schema : job.schemas)
    if (done) done = storage_.add(std::move(schema));
  for (auto& each : job.channels)
    if (done) done = storage_.add(std::move(each));
  for (auto& metadata : job.metadata)
    if (done) done = storage_.add(std::move(metadata));
  for (auto& lasting : job.lasting)
    if (done) done = storage_.add(std::move(lasting));
  if (!job.chunk) return done;
  if (done) return storage_.add(*job.chunk);
  discarded_ += job.chunk->messages;
  return done;
}

}  // namespace hc::record
