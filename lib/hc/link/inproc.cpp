// SPDX-License-Identifier: Apache-2.0
// `inproc:NAME`: links between threads of a process; the elements are shared, not serialised.

#include <map>
#include <mutex>
#include <string>

#include <hc/link/queue.h>
#include <hc/link/stream/source.h>
#include <hc/link/transports.h>
#include <hc/os/event.h>
#include <hc/os/reactor.h>

namespace hc::internal {
namespace {

constexpr std::size_t kCapacity = 64;  // queued messages before a sender with `keep=all` blocks

struct Channel {
  std::mutex mutex;
  SendQueue<Message> messages{Policy{}};
  Traffic losses;
  std::uint64_t taken = 0;  // messages that the source has taken
  bool has_source = false, has_sink = false;
  bool source_left = false, sink_left = false;
  Event readable;         // messages are queued, or the sink has left
  Event writable;         // the queue has room again, or the source has left
  bool is_paced = false;  // `rate` delays messages
  Watch timer;            // raises `readable` when the next message is due
};

/// Joins the channel with this name as one of its ends; creates it for the first.
Result<std::shared_ptr<Channel>> join(const std::string& name, bool Channel::*end) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<Channel>> channels;
  std::lock_guard lock(mutex);
  std::erase_if(channels, [](const auto& entry) { return entry.second.expired(); });
  auto channel = channels[name].lock();
  if (channel == nullptr) {
    channel = std::make_shared<Channel>();
    channel->readable = HC_TRY(Event::make());
    channel->writable = HC_TRY(Event::make());
    channels[name] = channel;
  }
  std::lock_guard channel_lock(channel->mutex);
  if ((*channel).*end)
    return Error{Code::System, "inproc:" + name + ": this end is in use already"};
  (*channel).*end = true;
  return channel;
}

class InprocSource final : public Source {
 public:
  explicit InprocSource(std::shared_ptr<Channel> channel) : channel_(std::move(channel)) {}
  ~InprocSource() override {
    std::lock_guard lock(channel_->mutex);
    channel_->source_left = true;
    channel_->messages.clear(channel_->losses);
    channel_->writable.raise();
  }

  Result<Got> take(Message& message) override {
    message = {};
    std::lock_guard lock(channel_->mutex);
    auto& messages = channel_->messages;
    if (messages.empty() && channel_->sink_left) return Got::End;
    TimePoint now;
    if (channel_->is_paced) now = std::chrono::steady_clock::now();
    if (auto ready = messages.ready_at(now, channel_->losses); ready > now) {
      channel_->readable.clear();
      if (ready != TimePoint::max()) channel_->timer.call_at(ready);
      return Got::Nothing;
    }
    message = messages.pop(now);
    ++channel_->taken;
    ++traffic_.messages;
    traffic_.bytes += message.elements.size();
    channel_->writable.raise();
    return Got::Message;
  }

  [[nodiscard]] int descriptor() const override { return channel_->readable.descriptor(); }
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

 private:
  Traffic traffic_;
  std::shared_ptr<Channel> channel_;
};

class InprocSink final : public Sink {
 public:
  InprocSink(std::shared_ptr<Channel> channel, const Policy& policy, const LinkOptions& options)
      : channel_(std::move(channel)),
        waits_(policy.writer_waits()),
        options_(options),
        patience_(policy.timeout, options.awaits_reader, options.log) {}
  ~InprocSink() override { leave(); }

  Status send(const Message& message) override {
    while (true) {
      {
        std::lock_guard lock(channel_->mutex);
        if (channel_->source_left) return Error{Code::Closed, "the reader disconnected"};
        const auto& waiting = channel_->messages;
        if (!waits_ ||
            (waiting.messages() < kCapacity && waiting.has_memory(message.elements.size()))) {
          channel_->messages.push(message.keep(), message.elements.size(), channel_->losses);
          channel_->readable.raise();
          ++messages_;
          bytes_ += message.elements.size();
          break;
        }
        if (!has_patience()) {
          ++messages_;
          ++channel_->losses.dropped_timeout;
          break;
        }
        channel_->writable.clear();
      }
      auto room = wait_for(channel_->writable.descriptor(), POLLIN, options_.stop, patience_.due());
      if (!room) {
        patience_.end();
        return room.error();
      }
    }
    patience_.end();
    return {};
  }

  Status close() override {
    leave();
    return {};
  }

  [[nodiscard]] bool is_behind() const override {
    std::lock_guard lock(channel_->mutex);
    return !channel_->messages.empty();
  }

  [[nodiscard]] Traffic traffic() const override {
    std::lock_guard lock(channel_->mutex);
    Traffic all = channel_->losses;
    all.messages = messages_;
    all.bytes += bytes_;
    return all;
  }

 private:
  /// Whether to wait for the source. Call it with the mutex locked.
  bool has_patience() {
    const auto taken = channel_->taken;
    return !patience_.is_over(taken) && patience_.waits(taken, std::chrono::steady_clock::now());
  }

  void leave() {
    std::lock_guard lock(channel_->mutex);
    channel_->sink_left = true;
    channel_->readable.raise();
  }

  std::shared_ptr<Channel> channel_;
  bool waits_;
  LinkOptions options_;
  Patience patience_;
  std::uint64_t messages_ = 0, bytes_ = 0;
};

}  // namespace

Result<std::unique_ptr<Source>> open_inproc_source(const Uri& uri, const LinkOptions&) {
  auto channel = HC_TRY(join(uri.rest, &Channel::has_source));
  return std::unique_ptr<Source>(new InprocSource(std::move(channel)));
}

Result<std::unique_ptr<Sink>> open_inproc_sink(const Uri& uri, const LinkOptions& options) {
  auto policy = HC_TRY(parse_policy(uri));
  auto joined = HC_TRY(join(uri.rest, &Channel::has_sink));
  auto& channel = *joined;
  std::unique_ptr<Sink> sink(new InprocSink(joined, policy, options));
  if (policy.is_paced()) {
    HC_TRY(channel.timer.start(-1, [&channel](auto) { channel.readable.raise(); }));
  }
  std::lock_guard lock(channel.mutex);
  channel.messages = SendQueue<Message>(policy);
  channel.is_paced = policy.is_paced();
  return sink;
}

}  // namespace hc::internal
