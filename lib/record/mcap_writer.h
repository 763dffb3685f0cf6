// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes streams to MCAP. Each has a topic with ROS 2 messages for viewers, and a topic `…/mtp`
// with the remaining data, so that its messages can be read back byte for byte (doc/recordings.md).
// Chunks are compressed and written on a second thread when they are full or half a second old.
// Internal to record.

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

/// Adds a name to `taken`: the wanted one, or the first free one of NAME_2, NAME_3, …
std::string take_name(std::set<std::string>& taken, const std::string& wanted);

class McapWriter {
 public:
  /// Errors: Invalid, System; those of Storage::make() and ros::GraphJoints::read().
  static Result<std::unique_ptr<McapWriter>> make(const std::string& file,
                                                  const WriterOptions& options);
  /// Calls close().
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Streams are numbered in the order in which they are added. "MODULE.PORT" gets the topic
  /// `/MODULE/PORT`, or a free one beside it. Traces, "MODULE.trace", get no topic for viewers,
  /// which would show a text for each module of a graph.
  void add_stream(const std::string& name);

  // Errors of all below: System (the disk); later calls return the same error.

  /// Blocks while too much is waiting to be written.
  /// Errors: TooLarge (no more channels in the file; other streams can continue).
  Status write(std::size_t stream, const Message& message, Time log_time);
  /// Copies a message of another file. `from` identifies the file. Errors: as write().
  Status copy(const StoredPair& pair, const void* from);
  /// Copies a channel of another file, if there is room.
  void copy_channel(const mcap::StoredMessage& message, const void* from);
  /// Writes a log line to /rosout, with ros::Encoder::encode_log().
  Status log(Time time, const LogLine& line);
  Status metadata(const std::string& name, const mcap::StringMap& words);
  /// As Storage::save(). Errors: also Closed.
  Result<std::string> save();
  Status close();

  /// As Storage::file().
  [[nodiscard]] const std::string& file() const { return file_; }
  // After close().
  [[nodiscard]] std::vector<std::string> files() const { return storage_.files(); }
  [[nodiscard]] std::uint64_t stored() const { return storage_.messages(); }
  /// Messages of MTP accepted but not written.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  struct Stream {
    std::string name, topic, matrix_topic;
    std::optional<ros::Type> type;  // of the first message, constant afterwards
    bool has_topic = false;         // `topic` has a channel
    bool is_shown = true;           // to viewers
    bool moves_frames = false;      // its messages are poses of frames
    std::map<ros::Type, std::uint16_t> channels;
  };
  struct Job {
    std::function<Status()> work;
    std::size_t bytes = 0;       // memory used
    std::uint64_t messages = 0;  // of MTP, lost if it fails
  };

  McapWriter(mcap::Storage storage, ros::GraphJoints joints, std::size_t chunk_bytes);
  void record_fixed_frames(Time time);
  std::uint16_t add_channel(mcap::ChannelRecord channel, mcap::SchemaRecord schema);
  std::uint16_t add_channel(const std::string& topic, ros::Type type, mcap::StringMap metadata);
  std::uint16_t channel(Stream& stream, ros::Type type);
  /// The channel of a topic without a stream, such as the log.
  std::uint16_t other_channel(std::string_view topic, ros::Type type);
  /// The channel in this file for a channel of another file.
  std::uint16_t copied_channel(const mcap::StoredMessage& message, const void* from);
  void add(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time,
           std::uint64_t publish_time, const ros::Pieces& data);
  /// Adds a message to a topic without a stream.
  void add_other(std::string_view topic, ros::Type type, Time time, const ros::Pieces& data);
  /// Adds a message of another file to the chunk.
  void add_copy(const mcap::StoredMessage& message, const void* from);
  /// Writes a record that each file contains.
  /// @param bytes  memory used by a large record.
  void repeat(mcap::Storage::Repeated record, std::size_t bytes = 0);
  /// Pass the chunk to the thread, if it is full or old, or in any case. Call them with
  /// chunk_mutex_ locked, so that no chunk ends between a message and its companion.
  void flush_if_due();
  void flush();
  void enqueue(Job job);
  /// Blocks while too much is waiting to be written. Not to be called on the thread.
  Status wait_for_room();
  void work();

  const std::size_t chunk_bytes_;
  ros::Encoder encoder_, matrix_encoder_;
  std::vector<Stream> streams_;
  ros::GraphJoints joints_;
  std::set<std::string> topics_;  // taken names
  std::set<std::string> names_;   // of streams
  std::uint16_t last_channel_ = 0;
  std::map<std::string, std::uint16_t> schemas_;  // by content
  // Channels without a stream, by topic and type.
  std::map<std::pair<std::string, std::string>, std::uint16_t> other_channels_;
  // For channels and topics of other files: their numbers and names in this file.
  std::map<const mcap::ChannelRecord*, std::uint16_t> copied_;
  std::map<std::pair<const void*, std::string>, std::string> copied_topics_;
  // How many channels of a file without a stream have the same definition.
  std::map<std::pair<const void*, std::string>, std::size_t> copied_counts_;
  std::mutex chunk_mutex_;  // guards the next two; locked before mutex_
  mcap::ChunkBuilder chunk_;
  std::chrono::steady_clock::time_point chunk_begun_;
  std::uint32_t others_ = 0;  // messages of log and joints
  bool is_closed_ = false;

  // Used only on the thread, until it has ended.
  mcap::Storage storage_;
  const std::string file_;
  std::uint64_t lost_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;     // the first one is in progress
  std::size_t waiting_ = 0;  // memory used by jobs_ [byte]
  bool is_ending_ = false;
  Status status_;
  std::thread thread_;
};

}  // namespace hc::record
