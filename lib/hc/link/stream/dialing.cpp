// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/dialing.h>

#include <hc/link/stream/sink.h>
#include <hc/link/stream/source.h>
#include <hc/link/transports.h>

namespace hc::internal {
namespace {

constexpr std::int64_t kMostSeconds = 86'400;  // of waiting

/// None where the link is to end with its connection. Errors: Invalid.
Result<std::unique_ptr<Dialer>> dialer_for(const Peer& peer, const Uri& uri) {
  auto patience = number_option(uri, "reconnect", 0, kMostSeconds);
  if (!patience) return patience.error();
  if (*patience == 0) return std::unique_ptr<Dialer>();
  auto first = number_option(uri, "wait", 0, kMostSeconds);
  if (!first) return first.error();
  if (*first == 0) first = *patience;
  return std::make_unique<Dialer>(peer, std::chrono::seconds(*first),
                                  std::chrono::seconds(*patience),
                                  std::chrono::steady_clock::now());
}

}  // namespace

Result<Descriptor> connect_now(const Peer& peer, const Uri& uri, const LinkOptions& options) {
  auto wait = number_option(uri, "wait", 0, kMostSeconds);
  if (!wait) return wait.error();
  const auto first = *wait > 0 ? std::chrono::seconds(*wait) : kAnswerTime;
  Dialer dialer(peer, first, first, std::chrono::steady_clock::now());
  while (true) {
    auto connected = dialer.dial(std::chrono::steady_clock::now());
    if (connected && *connected) return connected;
    if (!connected || (*wait == 0 && dialer.is_refused()))
      return Error{Code::Closed, "connect(" + peer.name + "): " + dialer.why()};
    auto waited = wait_for(dialer.descriptor(), POLLOUT, options.stop, dialer.due());
    if (!waited) return waited.error();
  }
}

Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options) {
  auto open = [options](Descriptor connection) {
    set_up_reader(connection.get());
    return Result<std::unique_ptr<Source>>(
        std::make_unique<StreamSource>(std::move(connection), options));
  };
  return dial_source(peer, uri, options, {open});
}

Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options, DialingSource::Made made) {
  auto dialer = dialer_for(peer, uri);
  if (!dialer) return dialer.error();
  if (*dialer != nullptr) return DialingSource::make(std::move(*dialer), std::move(made), options);
  auto connected = connect_now(peer, uri, options);
  if (!connected) return connected.error();
  return made.open(std::move(*connected));
}

Result<std::unique_ptr<Sink>> dial_sink(const Peer& peer, const Uri& uri,
                                        const LinkOptions& options) {
  auto dialer = dialer_for(peer, uri);
  if (!dialer) return dialer.error();
  if (*dialer != nullptr) return StreamSink::make(Descriptor(), uri, options, std::move(*dialer));
  auto connected = connect_now(peer, uri, options);
  if (!connected) return connected.error();
  return StreamSink::make(std::move(*connected), uri, options);
}

}  // namespace hc::internal
