// SPDX-License-Identifier: Apache-2.0
#include <tls/acceptor.h>

#include <netdb.h>
#include <sys/socket.h>

#include <array>
#include <utility>

#include <tls/channel.h>

namespace hc::tls {
namespace {

std::string name_of_peer(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  auto* place = reinterpret_cast<sockaddr*>(&address);
  if (::getpeername(socket, place, &size) != 0 ||
      ::getnameinfo(place, size, host.data(), host.size(), port.data(), port.size(),
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return "a peer";
  return std::string(host.data()) + " port " + port.data();
}

}  // namespace

Result<Descriptor> Acceptor::start() {
  Descriptor readable = HC_TRY(
      open_descriptor("eventfd", "", [] { return ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC); }));
  event_ = readable.get();
  loop_ = HC_TRY(Loop::make());
  auto watched = loop_->watch(socket_.descriptor.get(), EPOLLIN, [this](auto) { accept_all(); });
  if (!watched) return watched.error();
  listening_ = std::move(*watched);
  auto started = watch_.start(loop_->descriptor(), [this](auto) {
    static_cast<void>(loop_->turn(std::chrono::milliseconds(0)));
  });
  if (started) started = watch_.want(EPOLLIN);
  if (!started) return started.error();
  return readable;
}

ConnectedSocket Acceptor::take(const LogSink& log) {
  eventfd_t count = 0;
  ConnectedSocket peer;
  {
    std::lock_guard lock(mutex_);
    if (!accepted_.empty()) {
      peer = std::move(accepted_.front());
      accepted_.pop_front();
    }
    if (accepted_.empty()) ::eventfd_read(event_, &count);
  }
  remarks_.flush(log);
  return peer;
}

void Acceptor::accept_all() {
  auto has_room = [this] {
    std::lock_guard lock(mutex_);
    return accepted_.size() < kMaxAccepted;
  };
  socket_.accept_all(
      listening_, [this](Level, std::string_view line) { say(std::string(line)); }, has_room,
      [this](ConnectedSocket accepted) { return begin_handshake(std::move(accepted)); });
}

Status Acceptor::begin_handshake(ConnectedSocket accepted) {
  if (handshakes_.size() >= kMaxHandshakes) {
    handshakes_.pop_front();
    if (!std::exchange(is_crowded_, true))
      say("more than " + std::to_string(kMaxHandshakes) +
          " peers are in a TLS handshake; closing the oldest of them");
  }
  const int number = accepted.get();
  accepted.channel = std::make_unique<TlsChannel>(context_, number, TlsChannel::Side::Listens);
  const auto peer = handshakes_.insert(handshakes_.end(),
                                       {std::move(accepted), name_of_peer(number), Loop::Handle()});
  auto watched = loop_->watch(number, EPOLLIN, [this, peer](std::uint32_t events) {
    continue_handshake(peer, events == 0);
  });
  if (!watched) {
    handshakes_.erase(peer);
    return watched.error();
  }
  peer->watch = std::move(*watched);
  peer->watch.call_at(std::chrono::steady_clock::now() + kPatience);
  return {};
}

/// Continues a handshake; ends it if it is late.
void Acceptor::continue_handshake(Peer peer, bool is_late) {
  auto awaited = peer->socket.channel->agree();
  if (awaited && *awaited != 0 && !is_late) {
    static_cast<void>(peer->watch.want(static_cast<std::uint32_t>(*awaited)));
    return;
  }
  peer->watch.reset();
  if (!awaited) {
    say("refused " + peer->name + ": " + awaited.error().detail);
  } else if (*awaited == 0) {
    std::lock_guard lock(mutex_);
    accepted_.push_back(std::move(peer->socket));
    raise();
    // Sends the acceptance after the peer has been queued, so that take() finds it.
    static_cast<void>(accepted_.back().channel->write({}));
  } else if (!is_crowded_) {
    say("refused " + peer->name + ": no TLS handshake within " + std::to_string(kPatience.count()) +
        " s");
  }
  handshakes_.erase(peer);
  is_crowded_ = is_crowded_ && !handshakes_.empty();
}

void Acceptor::say(std::string line) {
  remarks_.add(std::move(line));
  raise();
}

}  // namespace hc::tls
