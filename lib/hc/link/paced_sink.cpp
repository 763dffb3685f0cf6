// SPDX-License-Identifier: Apache-2.0
#include <hc/link/paced_sink.h>

#include <sys/eventfd.h>

#include <mutex>

#include <hc/link/queue.h>
#include <hc/link/stream/source.h>
#include <hc/os/reactor.h>

namespace hc::internal {
namespace {

class PacedSink final : public Sink {
 public:
  PacedSink(std::unique_ptr<Sink> sink, const Policy& policy, Descriptor changed,
            const LinkOptions& options, std::shared_ptr<Remarks> remarks)
      : remarks_(std::move(remarks)),
        log_(options.log),
        sink_(std::move(sink)),
        writer_waits_(policy.writer_waits()),
        queue_(policy),
        changed_(std::move(changed)),
        stop_(options.stop) {}

  Status watch() {
    auto timer = Watch::make(-1, [this](std::uint32_t) { send_what_is_ready(); });
    if (!timer) return timer.error();
    timer_ = std::move(*timer);
    alarm_ = timer_.get();
    return {};
  }

  Status send(const Message& message) override {
    auto sent = put(message);
    remarks_->tell(log_);
    return sent;
  }

  Draft loan(const Header& header) override {
    std::lock_guard lock(mutex_);
    return sink_->loan(header);
  }

  /// What is kept back goes first, at its pace.
  Status close() override {
    auto closed = finish();
    remarks_->tell(log_);
    return closed;
  }

  void abandon() override {
    std::lock_guard lock(mutex_);
    lost_.cut += queue_.clear(lost_);
    sink_->abandon();
  }

  [[nodiscard]] Traffic traffic() const override {
    std::lock_guard lock(mutex_);
    Traffic traffic = sink_->traffic();
    const auto sent = traffic.bytes;
    traffic += lost_;
    traffic.bytes = sent;
    traffic.messages += lost_.lost() + queue_.size();
    return traffic;
  }

 private:
  using Clock = std::chrono::steady_clock;

  Status put(const Message& message) {
    auto bytes = message.elements.size();
    std::lock_guard lock(mutex_);
    if (!outcome_) return outcome_;
    auto now = Clock::now();
    if (queue_.pass(now)) return sink_->send(message);
    queue_.push(message.keep(), bytes, lost_);
    auto ready = queue_.ready_at(now, lost_);
    if (!writer_waits_) {
      alarm_->call_at(ready);
      return {};
    }
    if (auto waited = wait_until(ready); !waited) {
      queue_.take_back();
      return waited;
    }
    return sink_->send(queue_.pop(Clock::now()));
  }

  Status finish() {
    while (true) {
      {
        std::lock_guard lock(mutex_);
        if (!outcome_) return outcome_;
        if (queue_.empty()) return sink_->close();
        eventfd_t count = 0;
        ::eventfd_read(changed_.get(), &count);
      }
      if (auto waited = wait_for(changed_.get(), POLLIN, stop_); !waited) return waited.error();
    }
  }

  Status wait_until(TimePoint ready) const {
    auto waited = wait_for(-1, 0, stop_, ready);
    return waited ? Status() : waited.error();
  }

  void send_what_is_ready() {
    std::lock_guard lock(mutex_);
    while (outcome_ && !queue_.empty()) {
      auto now = Clock::now();
      if (auto ready = queue_.ready_at(now, lost_); ready > now) {
        alarm_->call_at(ready);
        return;
      }
      outcome_ = sink_->send(queue_.pop(now));
    }
    ::eventfd_write(changed_.get(), 1);
  }

  std::shared_ptr<Remarks> remarks_;  // of sink_, which may be used on another thread
  LogSink log_;
  mutable std::mutex mutex_;  // of what follows
  std::unique_ptr<Sink> sink_;
  bool writer_waits_;
  SendQueue<Message> queue_;
  Traffic lost_;
  Status outcome_;      // of the thread that serves links; told at the next call
  Descriptor changed_;  // eventfd: nothing waits any more, or the sink has failed
  int stop_;
  Watch* alarm_ = nullptr;  // for its callback, which may run while it is being destroyed
  std::unique_ptr<Watch> timer_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_paced(std::unique_ptr<Sink> sink, const Policy& policy,
                                         const LinkOptions& options,
                                         std::shared_ptr<Remarks> remarks) {
  if (!policy.is_paced()) return sink;
  auto changed =
      system_call("eventfd", "", [] { return ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC); });
  if (!changed) return changed.error();
  auto paced = std::make_unique<PacedSink>(std::move(sink), policy, Descriptor(*changed), options,
                                           std::move(remarks));
  if (auto watched = paced->watch(); !watched) return watched.error();
  return std::unique_ptr<Sink>(std::move(paced));
}

}  // namespace hc::internal
