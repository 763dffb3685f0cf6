// SPDX-License-Identifier: Apache-2.0
#pragma once
// A ROS 2 node: a DDS participant with writers and readers, by Cyclone DDS.

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dds/entity.h>
#include <hc/base/result.h>
#include <ros/cdr.h>
#include <ros/schema.h>

struct ddsi_sertype;

struct Qos {
  bool reliable = true;
  bool transient_local = false;  ///< late subscribers get the last messages
  std::int32_t depth = 10;       ///< messages kept
};

/// Writes a topic, from one thread at a time. Must be destroyed before its participant.
class Writer {
 public:
  /// Errors: System (a subscriber is too slow: the message is dropped after 0.1 s).
  hc::Status write(const hc::ros::Pieces& pieces);

 private:
  friend class Participant;
  hc::dds::Entity topic_, writer_;
  const ddsi_sertype* type_ = nullptr;
};

/// Reads a topic. Must be destroyed before its participant.
class Reader {
 public:
  /// Gets the bytes of a message, valid within the call, or an error.
  using Take = std::function<void(const hc::Result<std::span<const std::byte>>&)>;

  /// Takes the messages available, at most `depth`.
  void take(const Take& take);

 private:
  friend class Participant;
  hc::dds::Entity topic_, reader_;
  std::int32_t depth_ = 0;
};

class Participant {
 public:
  struct Options {
    std::uint32_t domain = 0;
    /// As ROS_AUTOMATIC_DISCOVERY_RANGE: LOCALHOST (loopback only), SUBNET, SYSTEM_DEFAULT, OFF.
    std::string range = "LOCALHOST";
    std::string node = "hypercolumn";
    bool is_humble = false;  ///< ROS 2 before Iron: longer ids, no type hashes
  };

  /// @param log  called on any thread with warnings of Cyclone DDS; must outlive the participant.
  /// Errors: Invalid (no such range or domain), System.
  static hc::Result<std::unique_ptr<Participant>> open(
      const Options& options, const std::function<void(std::string_view)>& log);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// From any thread. Errors: System.
  hc::Result<Writer> write(const std::string& topic, hc::ros::Type type, const Qos& qos);
  /// @param arrived  called on a thread of Cyclone DDS when messages arrive; must outlive the
  ///   participant.
  /// Errors: System.
  hc::Result<Reader> read(const std::string& topic, hc::ros::Type type, const Qos& qos,
                          const std::function<void()>& arrived);

 private:
  Participant() = default;
  hc::Result<Writer> open_writer(const std::string& topic, const std::string& type,
                                 std::string_view hash, const Qos& qos);
  /// Announces the node and its topics to ROS, after adding a writer or reader to a list.
  hc::Status announce(std::vector<dds_guid_t>* list = nullptr, dds_entity_t added = 0);

  Options options_;
  hc::dds::Entity domain_, participant_;
  Writer discovery_;
  std::mutex mutex_;  // guards the lists
  std::vector<dds_guid_t> writers_, readers_;
};

/// The configuration of Cyclone DDS for a range; empty if there is no such range.
std::string configuration(std::string_view range);
