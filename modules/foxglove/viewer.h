// SPDX-License-Identifier: Apache-2.0
#pragma once
// A connected viewer: its subscriptions and its queue. For one thread.

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <web/access.h>
#include <web/server.h>

#include "publisher.h"

class Viewer {
 public:
  Viewer(std::shared_ptr<hc::web::WebSocket> socket, hc::web::Right right);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  [[nodiscard]] hc::web::Right right() const { return right_; }

  /// Sends JSON. A viewer that does not read is disconnected; is_lost() is then true.
  void say(std::string json);
  [[nodiscard]] bool is_lost() const { return is_lost_; }
  /// Sends the server's time.
  void say_time(hc::Time time);
  /// Sends a warning (level 1) or error (2) for the viewer's list of problems; replaces an earlier
  /// one with the same id.
  void say_status(int level, const std::string& words, const std::string& id = {});

  /// @returns  false if the number or the channel is already subscribed, or there are too many.
  bool subscribe(std::uint32_t subscription, const Channel& channel);
  void unsubscribe(std::uint32_t subscription);
  /// Ends the subscription of a removed channel.
  void forget(std::uint32_t channel);
  [[nodiscard]] bool is_subscribed(std::uint32_t channel) const {
    return subscriptions_.contains(channel);
  }

  /// Queues a message, if the viewer subscribes to its channel. The queue is bounded: of large
  /// messages the newest of each channel, in all the newest 1024 and 8 MiB.
  void offer(std::uint32_t channel, const Payload& payload);
  /// Adds messages of a channel that were dropped before they were offered.
  void count_dropped(std::uint32_t channel, std::uint64_t messages);
  /// Reports the drops since the last report.
  void report_dropped();

  std::set<std::string> parameters;  ///< subscribed parameters
  bool all_parameters = false;
  bool graph = false;  ///< subscribed to the connection graph

 private:
  struct Outgoing {
    std::uint32_t channel = 0;
    Payload payload;
  };
  struct Subscription {
    std::uint32_t id = 0;
    std::string topic;
    std::uint64_t dropped = 0, reported = 0;  ///< messages
  };

  [[nodiscard]] std::optional<std::uint32_t> channel_of(std::uint32_t subscription) const;
  void drop(const std::deque<Outgoing>::iterator& which);
  void flush();

  const std::shared_ptr<hc::web::WebSocket> socket_;
  const hc::web::Right right_;
  bool is_lost_ = false;
  std::map<std::uint32_t, Subscription> subscriptions_;  // by channel
  std::deque<Outgoing> queue_;
  std::size_t queued_ = 0;  // [byte]
};
