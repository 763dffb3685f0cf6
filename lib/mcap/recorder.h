// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records streams of messages into MCAP. Each stream has one topic with messages of ROS 2, as
// viewers show them, and one below it, `…/mtp`, with what those lack: its messages come out of a
// recording byte for byte as they went in (doc/recordings.md).

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <hc/mtp/message.h>
#include <mcap/chunk.h>
#include <mcap/storage.h>
#include <ros/encode.h>
#include <ros/joints.h>

namespace hc::mcap {

struct RecorderOptions : StorageOptions {
  /// Bytes of messages that make a chunk, and how long one is gathered at most.
  std::size_t chunk_bytes = std::size_t{4} << 20;
  std::chrono::milliseconds chunk_time{500};
  std::size_t backlog = std::size_t{256} << 20;  ///< of chunks that wait to be written [byte]
  int level = 1;                                 ///< of zstd
};

/// Gathers messages; a thread of its own compresses and writes them. An object is used by one
/// thread.
class Recorder {
 public:
  /// Errors: Invalid, System; as Storage::make().
  static Result<std::unique_ptr<Recorder>> make(const RecorderOptions& options);
  /// Ends as close() does.
  ~Recorder();

  /// A stream of messages; gives its number.
  /// @param name  "MODULE.PORT", or any text: its topic is `/MODULE/PORT`. Traces, "MODULE.trace",
  ///     have none: viewers show a text for each of the graph's modules otherwise.
  std::size_t add_stream(std::string_view name);

  /// Records a message. Waits while the backlog is full.
  /// @param time  when it came [ns since the Unix epoch].
  ///
  /// Errors: System (the disk); nothing is recorded any more, and each later call gives the same.
  /// TooLarge (there are too many streams for a file); messages of the others are recorded.
  Status record(std::size_t stream, const Message& message, std::int64_t time);

  /// A line of the graph's log, as ros::Encoder::encode_log() takes it, on the topic /rosout.
  Status log(std::int64_t time, const LogLine& line);
  Status metadata(std::string name, Words words);

  /// The frames of the graph as text (spec/graph.md, G31): joints that never move are recorded on
  /// /tf_static, in each file, and those that streams move on /tf. Before the first stream.
  /// @param time  now [ns since the Unix epoch].
  /// Errors: as ros::GraphJoints::read().
  Status set_frames(const std::string& text, std::int64_t time);

  /// To be called now and then: hands on a chunk that has been gathered for long enough.
  Status poll();

  /// Writes what is kept of the last time into a file of its own; gives its name.
  /// Errors: System; Invalid (not a recorder that keeps the last time).
  Result<std::string> save();

  /// Writes all, and ends the file. Errors: System; also what went wrong before.
  Status close();

  /// Where it records; of several files the name they are numbered after.
  [[nodiscard]] const std::string& file() const { return options_.file; }
  /// Messages that record() was given.
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  /// Bytes of the messages as they came. [byte]
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// Those of them that are in no file; after close().
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  struct Stream {
    std::string name, topic, matrix_topic;
    std::optional<ros::Type> type;  // of its first message, fixed from then on
    std::uint16_t matrix = 0;       // channel; 0: none yet
    bool has_topic = false;         // taken by a channel
    bool is_shown = true;           // viewers can see it
    std::map<ros::Type, std::uint16_t> channels;
    bool moves_frames = false;  // its messages are poses of these
  };
  /// What the thread is to do.
  struct Job {
    std::optional<ChunkBuilder> chunk;
    bool in_each = false, saves = false;
    std::vector<SchemaRecord> schemas;
    std::vector<ChannelRecord> channels;
    std::vector<MetadataRecord> metadata;
  };

  Recorder(RecorderOptions options, Storage storage);
  /// A topic that no other channel has: the wanted one, or that with a number behind it.
  std::string take_topic(const std::string& wanted);
  std::uint16_t channel(const std::string& topic, ros::Type type, Words metadata);
  /// The channel of a stream for messages of a type.
  std::uint16_t channel(Stream& stream, ros::Type type);
  void add(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time,
           std::int64_t publish_time, const ros::Pieces& data);
  /// Records a message of none of the streams.
  void add_other(std::string_view topic, ros::Type type, std::int64_t time,
                 const ros::Pieces& data);
  /// Hands the chunk on when it is full or old.
  Status hand_on_if_due();
  Status hand_on(bool in_each = false);
  Status enqueue(Job job);
  void work();
  Status perform(Job& job, ChunkPacker& packer);

  RecorderOptions options_;
  ros::Encoder encoder_, matrix_encoder_;
  std::vector<Stream> streams_;
  ros::GraphJoints joints_;
  std::set<std::string> topics_;        // that are taken
  std::vector<std::uint16_t> schemas_;  // by type: its number, 0: none yet
  std::uint16_t last_schema_ = 0, last_channel_ = 0;
  std::map<std::string, std::uint16_t> other_channels_;  // of log and joints, by topic
  Job next_;  // schemas and channels that are to stand before the next chunk
  ChunkBuilder chunk_;
  std::chrono::steady_clock::time_point chunk_begun_;
  std::uint64_t messages_ = 0, bytes_ = 0, lost_ = 0;
  std::uint32_t others_ = 0;  // messages of log and joints
  bool is_closed_ = false;

  Storage storage_;              // of the thread, until it has ended
  std::uint64_t discarded_ = 0;  // messages of chunks after a failure; of the thread too
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::size_t waiting_ = 0;  // of chunks in jobs_ [byte]
  bool is_ending_ = false;
  Status status_;
  std::optional<Result<std::string>> saved_;
  std::thread thread_;
};

}  // namespace hc::mcap
