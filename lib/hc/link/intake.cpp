// SPDX-License-Identifier: Apache-2.0
#include <hc/link/intake.h>

namespace hc::internal {

Result<std::unique_ptr<Intake>> Intake::make(Loop& loop, const std::string& uri, Take take,
                                             const LinkOptions& options, bool is_limited) {
  auto parsed = HC_TRY(parse_uri(uri));
  auto source = HC_TRY(open_source(parsed, options));
  std::unique_ptr<Intake> intake(new Intake(loop, std::move(source), std::move(take), is_limited));
  intake->watch_ = HC_TRY(loop.watch(intake->source_->descriptor(), EPOLLIN,
                                     [self = intake.get()](auto) { self->take_unless_paused(); }));
  if (const int wakes = intake->source_->wake_descriptor(); wakes >= 0) {
    intake->wake_ = HC_TRY(loop.watch(wakes, EPOLLIN | EPOLLET,
                                      [self = intake.get()](auto) { self->take_unless_paused(); }));
  }
  // A source may have messages before its descriptor has become readable for the first time.
  intake->retry_ = loop.call_at({}, [self = intake.get()] { self->take(); });
  return intake;
}

void Intake::take_unless_paused() {
  if (!is_paused_) take();
}

void Intake::take_rest() {
  auto is_readable = [this] {
    const auto ready = wait_for(source_->descriptor(), POLLIN, -1, Deadline::clock::now());
    return ready && *ready;
  };
  for (int i = 0; i < kMaxRestTurns && watch_ && is_readable(); ++i) take();
}

void Intake::take() {
  Message message;
  for (int i = 0; i < kMaxPerTurn; ++i) {
    auto got = source_->take(message);
    if (!got || *got == Got::End) {
      watch_.reset();
      wake_.reset();
      retry_.reset();
      if (const auto end = end_) end();
      return;
    }
    if (*got == Got::Message)
      take_(message);
    else if (source_->prepare_wait())
      return;
  }
  is_paused_ = true;
  static_cast<void>(watch_.want(0));
  retry_ = loop_.call_at(std::chrono::steady_clock::now() + pause_, [this] {
    is_paused_ = false;
    static_cast<void>(watch_.want(EPOLLIN));
    take();
  });
}

}  // namespace hc::internal
