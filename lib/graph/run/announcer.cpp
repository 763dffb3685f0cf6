// SPDX-License-Identifier: Apache-2.0
#include <graph/run/announcer.h>

#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>

#include <hc/base/uri.h>
#include <hc/link/link.h>
#include <hc/link/stream/ends.h>
#include <hc/mtp/codec.h>

namespace hc::internal {

Result<std::unique_ptr<Announcer>> Announcer::make(Loop& loop, const std::string& uri,
                                                   std::function<std::vector<Message>()> welcome) {
  auto parsed = HC_TRY(parse_uri(uri));
  auto socket = HC_TRY(listen_unix(parsed));
  std::unique_ptr<Announcer> announcer(new Announcer(loop, std::move(socket), std::move(welcome)));
  announcer->watch_ = HC_TRY(loop.watch(announcer->socket_.descriptor.get(), EPOLLIN,
                                        [self = announcer.get()](auto) { self->let_in(); }));
  return announcer;
}

/// Ends the connection that has most unread, of several the oldest.
void Announcer::leave_idlest() {
  auto unread = [](const auto& peer) {
    int in_socket = 0;
    ::ioctl(peer->socket.get(), TIOCOUTQ, &in_socket);
    return peer->waiting.size() + static_cast<std::size_t>(in_socket);
  };
  peers_.erase(std::ranges::max_element(peers_, {}, unread));
}

void Announcer::let_in() {
  auto has_room = [] { return true; };
  socket_.accept_all(watch_, {}, has_room, [this](ConnectedSocket accepted) -> Status {
    if (peers_.size() >= kMostPeers) leave_idlest();
    auto peer = std::make_unique<Peer>();
    peer->socket = std::move(accepted.descriptor);
    peer->watch =
        HC_TRY(loop_.watch(peer->socket.get(), EPOLLIN,
                           [this, each = peer.get()](auto events) { serve(*each, events); }));
    peers_.push_back(std::move(peer));
    if (welcome_)
      for (const auto& message : welcome_()) put(*peers_.back(), encode(message));
    return {};
  });
  forget_those_who_left();
}

bool Announcer::say(const Message& message) {
  if (peers_.empty()) return true;
  const std::string bytes = encode(message);
  bool has_room = true;
  for (auto& peer : peers_) has_room = put(*peer, bytes) && has_room;
  forget_those_who_left();
  return has_room;
}

bool Announcer::put(Peer& peer, const std::string& bytes) {
  if (peer.waiting.size() + bytes.size() > kMostWaiting) return false;
  const bool was_waiting = !peer.waiting.empty();
  peer.waiting += bytes;
  if (!was_waiting) write(peer);
  return true;
}

void Announcer::write(Peer& peer) {
  const auto sent = ::send(peer.socket.get(), peer.waiting.data(), peer.waiting.size(),
                           MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent >= 0)
    peer.waiting.erase(0, static_cast<std::size_t>(sent));
  else if (errno != EAGAIN && errno != EINTR)
    peer.has_left = true;
  const auto watched = peer.watch.want(peer.waiting.empty() ? EPOLLIN : EPOLLIN | EPOLLOUT);
  peer.has_left = peer.has_left || !watched;
}

void Announcer::serve(Peer& peer, std::uint32_t events) {
  char piece[256];  // nothing is expected from it but its end
  if ((events & ~EPOLLOUT) != 0) {
    const auto size = ::recv(peer.socket.get(), piece, sizeof piece, MSG_DONTWAIT);
    peer.has_left = size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
  }
  if (!peer.has_left && !peer.waiting.empty()) write(peer);
  forget_those_who_left();
}

void Announcer::forget_those_who_left() {
  std::erase_if(peers_, [](const auto& peer) { return peer->has_left; });
}

Status say_at_once(const std::string& uri, const Message& message) {
  auto parsed = HC_TRY(parse_uri(uri));
  if (parsed.scheme != "unix") return Error{Code::Invalid, uri + ": only unix: can be said to"};
  parsed.options = {{"keep", "latest"}};  // so that nothing is waited for
  auto sink = HC_TRY(open_sink(parsed));
  auto sent = sink->send(message);
  sink->abandon();
  return sent;
}

}  // namespace hc::internal
