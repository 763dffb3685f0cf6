// SPDX-License-Identifier: Apache-2.0
#pragma once
// An output of the graph as a topic: observed while a viewer subscribes; each message is encoded
// once for all viewers.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <client/tap.h>
#include <hc/mtp/message.h>
#include <ros/encode.h>
#include <web/server.h>

/// A topic that viewers can subscribe to.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;  ///< "/head_eyes/left"
  std::string port;   ///< "head_eyes.left"; empty: the log or the frames
  hc::ros::Type type = hc::ros::Type::Matrix;
  bool operator==(const Channel&) const = default;
};

/// A message in CDR.
struct Payload {
  hc::Time time;  ///< of the message
  hc::web::Bytes bytes;
};

hc::web::Bytes bytes_of(const hc::ros::Pieces& pieces);

class Publisher {
 public:
  /// Called on the server's thread.
  struct Callbacks {
    std::function<void(const Payload&)> message;
    std::function<void(const std::string& why)> end;
  };

  /// @param frames  names of frames by number, for frame_ids.
  Publisher(hc::RunningGraph graph, Channel channel, std::map<std::int32_t, std::string> frames,
            hc::web::Post post, Callbacks callbacks);

  /// Messages dropped since the last call because the server's thread was busy.
  std::uint64_t take_dropped() { return shared_->dropped.exchange(0); }

 private:
  /// Bytes queued for the server's thread at which messages are dropped.
  static constexpr std::size_t kMaxWaiting = std::size_t{32} << 20;

  // On the tap's thread.
  void take(const hc::Message& message);
  void call(std::function<void(const Callbacks&)> what) const;

  const Channel channel_;
  const hc::web::Post post_;
  hc::ros::Encoder encoder_;
  std::string failed_;  // why the last message could not be encoded
  /// Shared with calls queued for the server's thread, which may run after the publisher has ended.
  struct Shared {
    Callbacks callbacks;
    std::atomic<std::size_t> waiting{0};  // [byte]
    std::atomic<std::uint64_t> dropped{0};
  };
  std::shared_ptr<Shared> shared_;
  hc::Tap tap_;  // last: its thread uses the above
};
