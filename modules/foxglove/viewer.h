// SPDX-License-Identifier: Apache-2.0
#pragma once
// A viewer that is connected: what it has subscribed to, and what waits for it. For one thread.

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

  /// Sends JSON. One who does not read what is said is disconnected, is_lost() then.
  void say(std::string json);
  [[nodiscard]] bool is_lost() const { return is_lost_; }
  /// Sends the time of the server. [ns since the Unix epoch]
  void say_time(std::int64_t time);
  /// A warning or an error, level 1 or 2, in the viewer's list of problems; it replaces one of the
  /// same id, where that is given.
  void say_status(int level, const std::string& words, const std::string& id = {});

  /// @returns  false: there is a subscription of that number, or of that channel, or too many.
  bool subscribe(std::uint32_t subscription, const Channel& channel);
  void unsubscribe(std::uint32_t subscription);
  /// Ends the subscription of a channel that is no longer there.
  void forget(std::uint32_t channel);
  [[nodiscard]] bool is_subscribed(std::uint32_t channel) const {
    return subscriptions_.contains(channel);
  }

  /// Sends a message soon, if it subscribes to that channel. What waits is bounded: of a large one
  /// only the newest, and of all the newest 1024 and 8 MiB.
  void offer(std::uint32_t channel, const Payload& payload);
  /// Counts messages of a channel that were dropped before they were offered.
  void count_dropped(std::uint32_t channel, std::uint64_t messages);
  /// Says what has been dropped since the last time.
  void report_dropped();

  std::set<std::string> parameters;  ///< whose changes it wants to know
  bool all_parameters = false;
  bool graph = false;  ///< wants to know the connection graph

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
