// SPDX-License-Identifier: Apache-2.0
#include <mcap/recorder.h>

#include <algorithm>

#include <hc/mtp/coords.h>

namespace hc::mcap {
namespace {

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

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::make(const RecorderOptions& options) {
  auto storage = Storage::make(options);
  if (!storage) return storage.error();
  return std::unique_ptr<Recorder>(new Recorder(options, std::move(*storage)));
}

Recorder::Recorder(RecorderOptions options, Storage storage)
    : options_(std::move(options)),
      topics_{std::string(kFrames), std::string(kStaticFrames), std::string(kLog)},
      schemas_(ros::schemas().size()),
      storage_(std::move(storage)) {
  options_.file = storage_.file();
  thread_ = std::thread([this] { work(); });
}

Recorder::~Recorder() {
  static_cast<void>(close());
}

std::size_t Recorder::add_stream(std::string_view name) {
  Stream stream;
  stream.name = name;
  stream.topic = take_topic(topic_of(name));
  stream.matrix_topic = take_topic(stream.topic + "/mtp");
  stream.moves_frames = joints_.are_moved_by(name);
  stream.is_shown = !name.ends_with(kTrace);
  streams_.push_back(std::move(stream));
  return streams_.size() - 1;
}

std::string Recorder::take_topic(const std::string& wanted) {
  std::string topic = wanted;
  for (int i = 2; !topics_.insert(topic).second; ++i) topic = wanted + "_" + std::to_string(i);
  return topic;
}

std::uint16_t Recorder::channel(const std::string& topic, ros::Type type, Words metadata) {
  const auto& schema = ros::schema(type);
  auto& number = schemas_[static_cast<std::size_t>(type)];
  if (number == 0) {
    number = ++last_schema_;
    next_.schemas.push_back({number, schema.name, "ros2msg", schema.text});
  }
  metadata["offered_qos_profiles"] = quality_of_service(topic == kStaticFrames);
  next_.channels.push_back({++last_channel_, number, topic, "cdr", std::move(metadata)});
  return last_channel_;
}

std::uint16_t Recorder::channel(Stream& stream, ros::Type type) {
  auto& number = stream.channels[type];
  if (number != 0) return number;
  if (stream.matrix == 0)
    stream.matrix =
        channel(stream.matrix_topic, ros::Type::Matrix, {{"hypercolumn.stream", stream.name}});
  // A topic has one type. What comes beside the first is rare: an image that is compressed.
  if (type == ros::Type::Matrix) return number = stream.matrix;
  std::string topic = stream.topic;
  if (std::exchange(stream.has_topic, true))
    topic = take_topic(topic + (type == ros::Type::CompressedImage
                                    ? "/compressed"
                                    : "/as_" + std::to_string(static_cast<int>(type))));
  return number = channel(topic, type, {{"hypercolumn.mtp", stream.matrix_topic}});
}

void Recorder::add(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time,
                   std::int64_t publish_time, const ros::Pieces& data) {
  if (chunk_.empty()) chunk_begun_ = std::chrono::steady_clock::now();
  const std::span<const std::byte> pieces[] = {data.head, data.body, data.tail};
  chunk_.add({channel, sequence, static_cast<std::uint64_t>(log_time),
              static_cast<std::uint64_t>(publish_time)},
             pieces);
}

Status Recorder::record(std::size_t number, const Message& message, std::int64_t time) {
  const Header& header = message.header;
  Stream& stream = streams_[number];
  const auto sequence = static_cast<std::uint32_t>(header.seq);
  const std::int64_t published = header.time != 0 ? header.time : time;
  ++messages_;
  bytes_ += message.elements.size();
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
  if (!has_channels && last_channel_ >= kMostChannels) {
    ++lost_;
    return Error{Code::TooLarge,
                 "MCAP: a file has room for " + std::to_string(kMostChannels) +
                     " topics, two for each stream; record fewer streams in one file"};
  }
  std::uint32_t offset = 0;
  if (type) {
    if (auto data = encoder_.encode(*type, message)) {
      add(channel(stream, *type), sequence, time, published, *data);
      if (!data->body.empty() && data->body.data() == message.elements.data())
        offset = static_cast<std::uint32_t>(data->head.size());
    }
  }
  add(channel(stream, ros::Type::Matrix), sequence, time, published,
      matrix_encoder_.encode_matrix(message, offset));
  ++chunk_.messages;
  if (stream.moves_frames) {
    if (auto joint = joints_.joint_of(message)) {
      joint->time = published;
      add_other(kFrames, ros::Type::TfMessage, time, encoder_.encode(std::span(&*joint, 1)));
    }
  }
  return hand_on_if_due();
}

void Recorder::add_other(std::string_view topic, ros::Type type, std::int64_t time,
                         const ros::Pieces& data) {
  auto& number = other_channels_[std::string(topic)];
  if (number == 0) number = channel(std::string(topic), type, {});
  add(number, ++others_, time, time, data);
}

Status Recorder::log(std::int64_t time, const LogLine& line) {
  add_other(kLog, ros::Type::Log, time, encoder_.encode_log(time, line));
  return hand_on_if_due();
}

Status Recorder::set_frames(const std::string& text, std::int64_t time) {
  auto joints = ros::GraphJoints::read(text);
  if (!joints) return joints.error();
  joints_ = std::move(*joints);
  encoder_.frames = joints_.names;
  for (auto& joint : joints_.fixed) joint.time = time;
  if (joints_.root.empty()) return {};
  auto fixed = joints_.fixed;
  fixed.push_back({.parent = std::string(kRerunOrigin), .child = joints_.root, .time = time});
  add_other(kStaticFrames, ros::Type::TfMessage, time, encoder_.encode(fixed));
  return hand_on(true);
}

Status Recorder::metadata(std::string name, Words words) {
  Job job;
  job.metadata.push_back({std::move(name), std::move(words)});
  return enqueue(std::move(job));
}

Status Recorder::hand_on_if_due() {
  if (chunk_.size() >= options_.chunk_bytes) return hand_on();
  return poll();
}

Status Recorder::poll() {
  if (!chunk_.empty() && std::chrono::steady_clock::now() - chunk_begun_ >= options_.chunk_time)
    return hand_on();
  const std::lock_guard lock(mutex_);
  return status_;
}

Status Recorder::hand_on(bool in_each) {
  Job job = std::exchange(next_, {});
  job.in_each = in_each;
  if (!chunk_.empty()) job.chunk = std::exchange(chunk_, {});
  return enqueue(std::move(job));
}

Status Recorder::enqueue(Job job) {
  std::unique_lock lock(mutex_);
  const std::size_t size = job.chunk ? job.chunk->size() : 0;
  changed_.wait(lock, [&] { return waiting_ == 0 || waiting_ + size <= options_.backlog; });
  waiting_ += size;
  jobs_.push_back(std::move(job));
  changed_.notify_all();
  return status_;
}

Result<std::string> Recorder::save() {
  if (options_.last.count() == 0)
    return Error{Code::Invalid, "only what is kept of the last time can be saved"};
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

Status Recorder::close() {
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
    lost_ += discarded_ + storage_.lost();
  }
  return status_;
}

void Recorder::work() {
  ChunkPacker packer(options_.level);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_ending_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    const std::size_t size = job.chunk ? job.chunk->size() : 0;
    if (status_) {
      lock.unlock();
      auto done = perform(job, packer);
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

Status Recorder::perform(Job& job, ChunkPacker& packer) {
  Status done;
  for (auto& schema : job.schemas)
    if (done) done = storage_.add(std::move(schema));
  for (auto& each : job.channels)
    if (done) done = storage_.add(std::move(each));
  for (auto& metadata : job.metadata)
    if (done) done = storage_.add(std::move(metadata));
  if (!job.chunk) return done;
  if (done) return storage_.add(packer.pack(*job.chunk), job.in_each);
  discarded_ += job.chunk->messages;
  return done;
}

}  // namespace hc::mcap
