// SPDX-License-Identifier: Apache-2.0
#pragma once
// Streams in a file of MCAP. Each has one topic with messages of ROS 2, as viewers show them, and
// one below it, `…/mtp`, with what those lack: its messages come out of a recording byte for byte
// as they went in (doc/recordings.md). Gathers messages; a thread of its own compresses and writes
// them. Internal to record.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <record/format.h>
#include <record/mcap/chunk.h>
#include <record/reader.h>
#include <ros/encode.h>
#include <ros/joints.h>

namespace hc::record {

class McapWriter final : public Format {
 public:
  /// Errors: Invalid, System; as Storage::make() and ros::GraphJoints::read().
  static Result<std::unique_ptr<Format>> make(const FormatOptions& options);
  ~McapWriter() override;
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// The stream "MODULE.PORT" has the topic `/MODULE/PORT`. Traces, "MODULE.trace", have none:
  /// viewers show a text for each of the graph's modules otherwise.
  Status add_stream(const std::string& name) override;
  /// Waits while the backlog is full.
  Status write(std::size_t stream, const Message& message, std::int64_t log_time) override;
  [[nodiscard]] bool copies_all() const override { return true; }
  Status write(const Stored& stored) override;
  /// As ros::Encoder::encode_log() takes it, on the topic /rosout.
  Status log(std::int64_t time, const LogLine& line) override;
  Status metadata(const std::string& name, const mcap::Words& words) override;
  Status poll() override;
  [[nodiscard]] bool keeps_last() const override { return options_.last.count() > 0; }
  Result<std::string> save() override;
  Status close() override;

  [[nodiscard]] const std::string& place() const override { return options_.file; }
  [[nodiscard]] std::vector<std::string> files() const override { return storage_.files(); }
  [[nodiscard]] std::uint64_t lost() const override { return discarded_ + storage_.lost(); }

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
    std::optional<mcap::ChunkBuilder> chunk;
    bool saves = false;
    std::vector<mcap::SchemaRecord> schemas;
    std::vector<mcap::ChannelRecord> channels;
    std::vector<mcap::MetadataRecord> metadata;
    std::vector<mcap::Lasting> lasting;
  };

  McapWriter(FormatOptions options, mcap::Storage storage, ros::GraphJoints joints);
  void record_fixed_frames(std::int64_t time);
  std::uint16_t add_channel(mcap::ChannelRecord channel, mcap::SchemaRecord schema);
  std::uint16_t channel(const std::string& topic, ros::Type type, mcap::Words metadata);
  /// Of a topic beside all streams, such as the log.
  std::uint16_t other_channel(std::string_view topic, ros::Type type);
  /// The channel here for one of another file; 0: there is no room.
  std::uint16_t channel(const Stored& stored);
  /// The channel of a stream for messages of a type.
  std::uint16_t channel(Stream& stream, ros::Type type);
  void add(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time,
           std::int64_t publish_time, std::span<const std::span<const std::byte>> data);
  /// Records a message of none of the streams.
  void add_other(std::string_view topic, ros::Type type, std::int64_t time,
                 const ros::Pieces& data);
  /// Hands the chunk on when it is full or old.
  Status hand_on_if_due();
  Status hand_on();
  Status enqueue(Job job);
  void work();
  Status perform(Job& job);

  FormatOptions options_;
  ros::Encoder encoder_, matrix_encoder_;
  std::vector<Stream> streams_;
  ros::GraphJoints joints_;
  std::set<std::string> topics_;  // that are taken
  std::set<std::string> names_;   // of streams
  std::uint16_t last_channel_ = 0;
  std::map<std::string, std::uint16_t> schemas_;  // by all that they say
  std::map<std::pair<std::string, std::string>, std::uint16_t>
      other_channels_;  // by topic and type
  Job next_;            // schemas and channels that are to stand before the next chunk
  /// Of other files: their channels here, and how their topics are called here.
  std::map<std::pair<const mcap::Reader*, std::uint16_t>, std::uint16_t> copied_;
  std::map<std::pair<const mcap::Reader*, std::string>, std::string> copied_topics_;
  mcap::ChunkBuilder chunk_;
  std::chrono::steady_clock::time_point chunk_begun_;
  std::uint32_t others_ = 0;  // messages of log and joints
  bool is_closed_ = false;

  mcap::Storage storage_;        // of the thread, until it has ended
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

}  // namespace hc::record
