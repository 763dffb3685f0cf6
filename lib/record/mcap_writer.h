// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes streams to MCAP. Each has a topic with messages of ROS 2 for viewers, and a topic `…/mtp`
// with what those lack, so that its messages can be read back byte for byte (doc/recordings.md).
// Chunks are compressed and written on a second thread, full ones at once and others when they are
// half a second old. Internal to record.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <record/mcap/storage.h>
#include <record/reader.h>
#include <record/writer.h>
#include <ros/encode.h>
#include <ros/joints.h>

namespace hc::record {

/// Adds a name to `taken`: the wanted one or, where it is there, the first free NAME_2, NAME_3, …
std::string take_name(std::set<std::string>& taken, const std::string& wanted);

class McapWriter {
 public:
  /// Errors: Invalid, System; as Storage::make() and ros::GraphJoints::read().
  static Result<std::unique_ptr<McapWriter>> make(const std::string& file,
                                                  const WriterOptions& options);
  /// Ends as close() does.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Streams are numbered in the order in which they are added. "MODULE.PORT" gets the topic
  /// `/MODULE/PORT`, or a free one beside it. Traces, "MODULE.trace", get none for viewers, which
  /// would show a text for each module of a graph.
  void add_stream(const std::string& name);

  // Errors of all below: System (the disk); every later call returns the same error.

  /// Blocks while too much is waiting to be written.
  /// Errors: TooLarge (the file has no room for another channel; other streams can go on).
  Status write(std::size_t stream, const Message& message, std::int64_t log_time);
  /// Copies a message of another file. `from` identifies the file. Errors: as write().
  Status copy(const StoredPair& pair, const void* from);
  /// Writes a line of the log on the topic /rosout, by ros::Encoder::encode_log().
  Status log(std::int64_t time, const LogLine& line);
  Status metadata(const std::string& name, const mcap::StringMap& words);
  /// As Storage::save(). Errors: also Closed.
  Result<std::string> save();
  Status close();

  /// As Storage has it.
  [[nodiscard]] const std::string& file() const { return file_; }
  // After close().
  [[nodiscard]] std::vector<std::string> files() const { return storage_.files(); }
  /// Messages of MTP that were accepted and not written.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  struct Stream {
    std::string name, topic, matrix_topic;
    std::optional<ros::Type> type;  // of its first message, fixed from then on
    bool has_topic = false;         // `topic` has a channel
    bool is_shown = true;           // to viewers
    bool moves_frames = false;      // its messages are poses of frames
    std::map<ros::Type, std::uint16_t> channels;
  };
  /// Work for the thread.
  struct Job {
    std::function<Status()> work;
    std::size_t bytes = 0;       // memory that it holds
    std::uint64_t messages = 0;  // of MTP, lost if it is not done
  };

  McapWriter(mcap::Storage storage, ros::GraphJoints joints, std::size_t chunk_bytes);
  void record_fixed_frames(std::int64_t time);
  std::uint16_t add_channel(mcap::ChannelRecord channel, mcap::SchemaRecord schema);
  std::uint16_t add_channel(const std::string& topic, ros::Type type, mcap::StringMap metadata);
  /// The channel of a stream for messages of a type.
  std::uint16_t channel(Stream& stream, ros::Type type);
  /// The channel of a topic that belongs to no stream, such as the log.
  std::uint16_t other_channel(std::string_view topic, ros::Type type);
  /// The channel here for one of another file.
  std::uint16_t copied_channel(const mcap::StoredMessage& message, const void* from);
  void add(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time,
           std::int64_t publish_time, const ros::Pieces& data);
  /// Adds a message of no stream.
  void add_other(std::string_view topic, ros::Type type, std::int64_t time,
                 const ros::Pieces& data);
  /// Adds a message of another file to the chunk.
  void add_copy(const mcap::StoredMessage& message, const void* from);
  /// Writes what each file contains.
  /// @param bytes  of memory, where they may be many.
  void repeat(mcap::Storage::Repeated record, std::size_t bytes = 0);
  /// Passes the chunk to the thread: if it is full or old, or in any case. Never between a message
  /// and its companion: whoever adds them holds chunk_mutex_.
  void flush_if_due();
  void flush();
  void enqueue(Job job);
  /// Waits while too much waits to be written. Not for the thread, which writes it.
  Status wait_for_room();
  void work();

  const std::size_t chunk_bytes_;
  ros::Encoder encoder_, matrix_encoder_;
  std::vector<Stream> streams_;
  ros::GraphJoints joints_;
  std::set<std::string> topics_;  // that are taken
  std::set<std::string> names_;   // of streams
  std::uint16_t last_channel_ = 0;
  std::map<std::string, std::uint16_t> schemas_;  // by all that they say
  // Channels of no stream, by topic and type.
  std::map<std::pair<std::string, std::string>, std::uint16_t> other_channels_;
  // Of other files: their channels here, and how their topics are called here.
  std::map<const mcap::ChannelRecord*, std::uint16_t> copied_;
  std::map<std::pair<const void*, std::string>, std::string> copied_topics_;
  std::mutex chunk_mutex_;  // of the next two; locked before mutex_
  mcap::ChunkBuilder chunk_;
  std::chrono::steady_clock::time_point chunk_begun_;
  std::uint32_t others_ = 0;  // messages of log and joints
  bool is_closed_ = false;

  // Of the thread, until it has ended.
  mcap::Storage storage_;
  const std::string file_;
  std::uint64_t lost_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;     // the first one is in progress
  std::size_t waiting_ = 0;  // memory that they hold [byte]
  bool is_ending_ = false;
  Status status_;
  std::thread thread_;
};

}  // namespace hc::record
