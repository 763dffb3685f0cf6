// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "json.h"

namespace {

constexpr std::size_t kMaxQueued = std::size_t{8} << 20, kMaxMessages = 1024;  // [byte], 1
constexpr std::size_t kLarge = 65536;     // of larger messages only the newest is queued [byte]
constexpr std::size_t kMaxWaiting = 512;  // unread texts
constexpr std::size_t kMaxUnderWay = 2;   // messages given to the socket
constexpr std::size_t kMaxSubscriptions = 1024;
constexpr char kMessageData = 1, kTime = 2;

/// A binary message of little-endian numbers.
template <typename... Number>
std::string binary(char opcode, Number... number) {
  std::string bytes(1, opcode);
  (bytes.append(reinterpret_cast<const char*>(&number), sizeof number), ...);
  return bytes;
}

}  // namespace

Viewer::Viewer(std::shared_ptr<hc::web::WebSocket> socket, hc::web::Right right)
    : socket_(std::move(socket)), right_(right) {
  socket_->on_sent = [this] { flush(); };
}

Viewer::~Viewer() {
  socket_->close(1001, "the graph has ended");
}

void Viewer::say(std::string json) {
  if (socket_->waiting() < kMaxWaiting) return socket_->send_text(std::move(json));
  is_lost_ = true;
  socket_->close(1008, "too slow: 512 messages are unread");
}

void Viewer::say_time(hc::Time time) {
  if (socket_->waiting() < kMaxUnderWay)
    socket_->send(std::make_shared<const std::string>(), binary(kTime, hc::unix_nanoseconds(time)));
}

void Viewer::say_status(int level, const std::string& words, const std::string& id) {
  Json status = {{"op", "status"}, {"level", level}, {"message", words}};
  if (!id.empty()) status["id"] = id;
  say(text(status));
}

bool Viewer::subscribe(std::uint32_t subscription, const Channel& channel) {
  if (channel_of(subscription) || subscriptions_.size() >= kMaxSubscriptions) return false;
  return subscriptions_.try_emplace(channel.id, Subscription{subscription, channel.topic}).second;
}

std::optional<std::uint32_t> Viewer::channel_of(std::uint32_t subscription) const {
  for (const auto& [channel, each] : subscriptions_)
    if (each.id == subscription) return channel;
  return std::nullopt;
}

void Viewer::unsubscribe(std::uint32_t subscription) {
  if (const auto channel = channel_of(subscription)) forget(*channel);
}

void Viewer::forget(std::uint32_t channel) {
  subscriptions_.erase(channel);
  std::erase_if(queue_, [&](const Outgoing& each) {
    if (each.channel != channel) return false;
    queued_ -= each.payload.bytes->size();
    return true;
  });
}

void Viewer::count_dropped(std::uint32_t channel, std::uint64_t messages) {
  const auto found = subscriptions_.find(channel);
  if (found != subscriptions_.end()) found->second.dropped += messages;
}

void Viewer::drop(const std::deque<Outgoing>::iterator& which) {
  queued_ -= which->payload.bytes->size();
  ++subscriptions_.at(which->channel).dropped;
  queue_.erase(which);
}

void Viewer::offer(std::uint32_t channel, const Payload& payload) {
  if (!is_subscribed(channel)) return;
  if (payload.bytes->size() >= kLarge) {
    const auto older = std::ranges::find(queue_, channel, &Outgoing::channel);
    if (older != queue_.end()) drop(older);
  }
  queue_.push_back({channel, payload});
  queued_ += payload.bytes->size();
  while (queue_.size() > kMaxMessages || (queued_ > kMaxQueued && queue_.size() > 1))
    drop(queue_.begin());
  flush();
}

void Viewer::flush() {
  while (!queue_.empty() && socket_->waiting() < kMaxUnderWay) {
    auto [channel, payload] = std::move(queue_.front());
    queue_.pop_front();
    queued_ -= payload.bytes->size();
    socket_->send(payload.bytes, binary(kMessageData, subscriptions_.at(channel).id,
                                        hc::unix_nanoseconds(payload.time)));
  }
}

void Viewer::report_dropped() {
  for (auto& [channel, each] : subscriptions_) {
    if (each.dropped == each.reported) continue;
    each.reported = each.dropped;
    say_status(1,
               std::to_string(each.dropped) + " messages of " + each.topic +
                   " were dropped: this viewer or its network is too slow",
               "dropped:" + each.topic);
  }
}
