// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/dialing_source.h>

#include <algorithm>

namespace hc::internal {
namespace {

/// How long the writer may be away that said its end, until it is told: where both ends are ended
/// together, the reader's end follows.
constexpr std::chrono::milliseconds kTellAfter{200};

}  // namespace

Result<std::unique_ptr<Source>> DialingSource::make(std::unique_ptr<Dialer> dialer, Made made,
                                                    const LinkOptions& options) {
  auto loop = Loop::make();
  if (!loop) return loop.error();
  std::unique_ptr<DialingSource> source(
      new DialingSource(std::move(dialer), std::move(made), std::move(*loop), options));
  static_cast<void>(source->dial());  // the first take() tells if it is in vain
  return std::unique_ptr<Source>(std::move(source));
}

Result<Got> DialingSource::take(Message& message) {
  message = {};
  while (!ended_) {
    if (source_ == nullptr && finishing_) break;
    if (source_ == nullptr) {
      if (auto dialed = dial(); !dialed) {
        ended_ = true;
        if (dialed.error().code == Code::NotFound) return dialed.error();
        log(in_words(dialed.error()));
        break;
      }
      if (source_ == nullptr) return Got::Nothing;
    }
    auto got = source_->take(message);
    bool is_lost = got ? *got == Got::End
                       : got.error().code == Code::Truncated || got.error().code == Code::Closed;
    if (!is_lost) return got;
    if (!got && got.error().code == Code::Truncated) ++past_.cut;
    lose_connection(got ? "" : in_words(got.error()));
  }
  ended_ = true;
  return Got::End;
}

/// Does what is due for a connection, and has the descriptor tell when there is more to do.
Status DialingSource::dial() {
  auto now = std::chrono::steady_clock::now();
  watch_.reset();  // before the dialer closes its descriptor
  retry_.reset();
  auto connected = dialer_->dial(now);
  if (!connected) return connected.error();
  if (auto remark = dialer_->take_remark(now)) log(*remark);
  if (now >= tell_at_) {
    log("sender closed; reconnecting");
    tell_at_ = TimePoint::max();
  }
  if (*connected) {
    auto source = made_.open(std::move(*connected));
    if (!source) {
      if (source.error().code == Code::Stopped) return source.error();
      log(in_words(source.error()) + "; reconnecting");
      dialer_->lost(now, false, in_words(source.error()));
    } else {
      source_ = std::move(*source);
      watch(source_->descriptor(), EPOLLIN);
      connected_at_ = now;
      tell_at_ = TimePoint::max();
    }
  }
  if (source_ == nullptr) {
    retry_ = loop_->call_at(std::min(dialer_->due(), tell_at_), [] {});
    if (dialer_->descriptor() >= 0) watch(dialer_->descriptor(), EPOLLOUT);
  }
  return {};
}

void DialingSource::lose_connection(const std::string& why) {
  const bool was_heard = source_->traffic().messages > 0;
  past_ += source_->traffic();
  watch_.reset();
  source_.reset();
  if (finishing_) return;
  auto now = std::chrono::steady_clock::now();
  if (why.empty())
    tell_at_ = now + kTellAfter;
  else
    log(why + "; reconnecting");
  dialer_->lost(now, was_heard && now - connected_at_ >= Dialer::kUseTime,
                why.empty() ? "sender closed" : why);
}

void DialingSource::watch(int descriptor, std::uint32_t events) {
  auto watched = loop_->watch(descriptor, events, [](auto) {});
  if (watched) watch_ = std::move(*watched);
}

void DialingSource::log(std::string_view line) const {
  if (options_.log) options_.log(Severity::Warning, line);
}

Traffic DialingSource::traffic() const {
  Traffic all = past_;
  if (source_ != nullptr) all += source_->traffic();
  return all;
}

}  // namespace hc::internal
