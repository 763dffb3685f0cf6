// SPDX-License-Identifier: Apache-2.0
#include <hc/link/paced_source.h>

#include <tuple>

#include <hc/os/loop.h>

namespace hc::internal {
namespace {

class PacedSource final : public Source {
 public:
  PacedSource(std::unique_ptr<Source> source, const Policy& policy, std::unique_ptr<Loop> loop)
      : source_(std::move(source)), pace_(policy), loop_(std::move(loop)) {}

  Result<Got> take(Message& message) override {
    // The callbacks do nothing; this re-arms the descriptor for events from now on.
    HC_TRY(loop_->turn(std::chrono::milliseconds(0)));
    const auto now = std::chrono::steady_clock::now();
    if (auto ready = pace_.ready_at(now, 1); ready > now) {
      message = {};
      if (!timer_) hold(ready);
      return Got::Nothing;
    }
    const bool was_held = static_cast<bool>(timer_);
    HC_TRY(watch());
    const auto before = source_->traffic();
    auto got = source_->take(message);
    const auto after = source_->traffic();
    if (was_held) overtaken_ += after.dropped_newer - before.dropped_newer;
    if (!got || *got != Got::Message) return got;
    pace_.take(now, after.bytes - before.bytes);
    if (was_held) ++delayed_;
    return got;
  }

  [[nodiscard]] int descriptor() const override { return loop_->descriptor(); }
  bool prepare_wait() override { return timer_ || source_->prepare_wait(); }
  void finish() override { source_->finish(); }

  [[nodiscard]] Traffic traffic() const override {
    Traffic traffic = source_->traffic();
    traffic.dropped_newer -= overtaken_;
    traffic.throttled += overtaken_;
    traffic.delayed += delayed_;
    return traffic;
  }

 private:
  /// Waits for the time only, not for messages.
  void hold(TimePoint ready) {
    socket_.reset();
    wake_.reset();
    timer_ = loop_->call_at(ready, [] {});
  }

  Status watch() {
    timer_.reset();
    for (auto [handle, descriptor, events] :
         {std::tuple{&socket_, source_->descriptor(), std::uint32_t{EPOLLIN}},
          {&wake_, source_->wake_descriptor(), EPOLLIN | EPOLLET}}) {
      if (*handle || descriptor < 0) continue;
      *handle = HC_TRY(loop_->watch(descriptor, events, [](auto) {}));
    }
    return {};
  }

  std::unique_ptr<Source> source_;
  Pace pace_;
  std::uint64_t overtaken_ = 0, delayed_ = 0;  // messages, because of the pace
  std::unique_ptr<Loop> loop_;
  Loop::Handle socket_, wake_;  // the source's descriptors, while a message may be taken
  Loop::Handle timer_;          // while none may
};

}  // namespace

Result<std::unique_ptr<Source>> make_paced(std::unique_ptr<Source> source, const Policy& policy) {
  if (!policy.is_paced()) return source;
  auto loop = HC_TRY(Loop::make());
  return std::unique_ptr<Source>(new PacedSource(std::move(source), policy, std::move(loop)));
}

}  // namespace hc::internal
