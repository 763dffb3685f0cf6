// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/ends.h>

#include <algorithm>
#include <utility>

#include <hc/link/stream/source.h>
#include <hc/os/loop.h>

namespace hc::internal {
namespace {

constexpr std::int64_t kMostSeconds = 86'400;  // of waiting
/// The delay before a closed connection is logged: a reader that is stopped with it logs nothing.
constexpr std::chrono::milliseconds kLogAfter{200};

/// A source that reconnects; see dial_source().
class DialingSource final : public Source {
 public:
  DialingSource(std::unique_ptr<Dialer> dialer, Made made, std::unique_ptr<Loop> loop,
                LinkOptions options)
      : dialer_(std::move(dialer)),
        made_(std::move(made)),
        loop_(std::move(loop)),
        options_(std::move(options)) {
    dialer_->log_to(options_.log);
    static_cast<void>(dial());  // the first take() reports a failure
  }

  Result<Got> take(Message& message) override {
    while (!ended_) {
      if (source_ == nullptr) {
        auto dialed = finishing_ ? Status() : dial();
        ended_ = finishing_ || !dialed;
        if (!dialed && dialed.error().code == Code::NotFound) return dialed.error();
        if (!dialed && options_.log) options_.log(Level::Warning, in_words(dialed.error()));
        if (source_ == nullptr) break;
      }
      auto got = source_->take(message);
      if (got && *got != Got::End) return got;
      if (!got && got.error().code == Code::System) return got;
      if (!got && got.error().code == Code::Truncated) ++past_.dropped_disconnect;
      const bool said_no_message = !got && is_bad(got.error());
      if (said_no_message) ++past_.bad;
      lose_connection(got ? "" : in_words(got.error()), said_no_message);
    }
    message = {};
    return ended_ ? Got::End : Got::Nothing;
  }

  [[nodiscard]] int descriptor() const override { return loop_->descriptor(); }
  bool prepare_wait() override { return source_ == nullptr || source_->prepare_wait(); }
  [[nodiscard]] int wake_descriptor() const override { return made_.wake_descriptor; }
  [[nodiscard]] Spin spin() const override { return source_ == nullptr ? Spin() : source_->spin(); }
  void finish() override { finishing_ = true; }
  [[nodiscard]] std::optional<std::size_t> peers() const override {
    return source_ == nullptr ? 0 : 1;
  }
  [[nodiscard]] Traffic traffic() const override {
    Traffic all = past_;
    if (source_ != nullptr) all += source_->traffic();
    return all;
  }

 private:
  /// Works on the connection, and sets up the events and the time to continue at.
  Status dial() {
    auto now = std::chrono::steady_clock::now();
    watch_.reset();  // before the dialer closes its descriptor
    retry_.reset();
    auto connected = HC_TRY(dialer_->dial(now));
    if (connected) {
      auto source = made_.open(std::move(connected));
      if (!source) {
        if (source.error().code == Code::Stopped) return source.error();
        dialer_->lost(now, false, in_words(source.error()));
      } else {
        source_ = std::move(*source);
        watch(source_->descriptor(), EPOLLIN);
        connected_at_ = now;
        dialer_->in_use();
      }
    }
    if (source_ == nullptr) {
      retry_ = loop_->call_at(dialer_->due(), [] {});
      if (dialer_->descriptor() >= 0) watch(dialer_->descriptor(), dialer_->events());
    }
    return {};
  }

  /// @param why  empty: the sender has closed.
  void lose_connection(const std::string& why, bool said_no_message) {
    const bool was_heard = source_->traffic().messages > 0;
    past_ += source_->traffic();
    watch_.reset();
    source_.reset();
    if (finishing_) return;
    auto now = std::chrono::steady_clock::now();
    const bool was_of_use =
        !said_no_message && was_heard && now - connected_at_ >= Dialer::kUseTime;
    if (why.empty())
      dialer_->lost(now, was_of_use, "sender closed", kLogAfter);
    else
      dialer_->lost(now, was_of_use, why);
  }

  void watch(int descriptor, short events) {
    auto watched = loop_->watch(descriptor, static_cast<std::uint32_t>(events), [](auto) {});
    if (watched) watch_ = std::move(*watched);
  }

  std::unique_ptr<Dialer> dialer_;
  Made made_;
  std::unique_ptr<Loop> loop_;  // only its descriptor is used
  Loop::Handle watch_;          // of the connection, or the attempt to make one
  Loop::Handle retry_;
  LinkOptions options_;
  std::unique_ptr<Source> source_;  // null: not connected
  TimePoint connected_at_;
  bool finishing_ = false;  // do not reconnect
  bool ended_ = false;
  Traffic past_;  // of former connections
};

/// Null if the link ends with its connection. Errors: Invalid.
Result<std::unique_ptr<Dialer>> dialer_for(const Peer& peer, const Uri& uri) {
  auto patience = HC_TRY(number_option(uri, "reconnect", 0, {0, kMostSeconds}));
  if (patience == 0) return std::unique_ptr<Dialer>();
  auto first = HC_TRY(number_option(uri, "wait", 0, {0, kMostSeconds}));
  if (first == 0) first = patience;
  return std::make_unique<Dialer>(peer, std::chrono::seconds(first), std::chrono::seconds(patience),
                                  std::chrono::steady_clock::now());
}

}  // namespace

Result<ConnectedSocket> connect_now(const Peer& peer, const Uri& uri, const LinkOptions& options) {
  auto wait = HC_TRY(number_option(uri, "wait", 0, {0, kMostSeconds}));
  const auto first = wait > 0 ? std::chrono::seconds(wait) : kAnswerTime;
  Peer found = peer;
  if (wait == 0 && peer.find) {
    auto lookup = HC_TRY(Detached<Found>::begin(peer.find));
    HC_TRY(wait_for(lookup.descriptor(), POLLIN, options.stop));
    found.addresses = HC_TRY(*lookup.take());
    found.find = {};
  }
  Dialer dialer(std::move(found), first, first, std::chrono::steady_clock::now());
  while (true) {
    auto connected = dialer.dial(std::chrono::steady_clock::now());
    if (connected && *connected) return connected;
    if (!connected || (wait == 0 && dialer.is_refused()))
      return Error{Code::Closed, "connect(" + peer.name + "): " + dialer.why()};
    HC_TRY(wait_for(dialer.descriptor(), dialer.events(), options.stop, dialer.due()));
  }
}

Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options, Made made) {
  if (!made.open)
    made.open = [options](ConnectedSocket connection) {
      set_up_reader(connection.get());
      return Result<std::unique_ptr<Source>>(
          std::make_unique<StreamSource>(std::move(connection), options));
    };
  auto dialer = HC_TRY(dialer_for(peer, uri));
  if (dialer == nullptr) {
    auto connected = connect_now(peer, uri, options);
    return connected ? made.open(std::move(*connected)) : connected.error();
  }
  auto loop = HC_TRY(Loop::make());
  return std::unique_ptr<Source>(
      new DialingSource(std::move(dialer), std::move(made), std::move(loop), options));
}

Result<std::unique_ptr<Sink>> dial_sink(const Peer& peer, const Uri& uri,
                                        const LinkOptions& options) {
  auto dialer = HC_TRY(dialer_for(peer, uri));
  if (dialer != nullptr)
    return make_stream_sink(ConnectedSocket(), uri, options, std::move(dialer));
  auto connected = HC_TRY(connect_now(peer, uri, options));
  return make_stream_sink(std::move(connected), uri, options);
}

}  // namespace hc::internal
