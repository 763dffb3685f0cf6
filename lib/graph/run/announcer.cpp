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
                                        [self = announcer.get()](auto) { self->accept(); }));
  return announcer;
}

/// Disconnects the peer with most unread, of several the oldest.
void Announcer::disconnect_slowest() {
  auto unread = [](const auto& peer) {
    int in_socket = 0;
    ::ioctl(peer->socket.get(), TIOCOUTQ, &in_socket);
    return peer->queued.size() + static_cast<std::size_t>(in_socket);
  };
  peers_.erase(std::ranges::max_element(peers_, {}, unread));
}

void Announcer::accept() {
  auto has_room = [] { return true; };
  socket_.accept_all(watch_, {}, has_room, [this](ConnectedSocket accepted) -> Status {
    if (peers_.size() >= kMaxPeers) disconnect_slowest();
    auto peer = std::make_unique<Peer>();
    peer->socket = std::move(accepted.descriptor);
    peer->watch =
        HC_TRY(loop_.watch(peer->socket.get(), EPOLLIN,
                           [this, each = peer.get()](auto events) { serve(*each, events); }));
    peers_.push_back(std::move(peer));
    if (welcome_)
      for (const auto& message : welcome_()) enqueue(*peers_.back(), encode(message));
    return {};
  });
  remove_closed();
}

bool Announcer::send(const Message& message) {
  if (peers_.empty()) return true;
  const std::string bytes = encode(message);
  bool has_room = true;
  for (auto& peer : peers_) has_room = enqueue(*peer, bytes) && has_room;
  remove_closed();
  return has_room;
}

bool Announcer::enqueue(Peer& peer, const std::string& bytes) {
  if (peer.queued.size() + bytes.size() > kMaxQueued) return false;
  const bool was_empty = peer.queued.empty();
  peer.queued += bytes;
  if (was_empty) write(peer);
  return true;
}

void Announcer::write(Peer& peer) {
  const auto sent = ::send(peer.socket.get(), peer.queued.data(), peer.queued.size(),
                           MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent >= 0)
    peer.queued.erase(0, static_cast<std::size_t>(sent));
  else if (errno != EAGAIN && errno != EINTR)
    peer.is_closed = true;
  const auto watched = peer.watch.want(peer.queued.empty() ? EPOLLIN : EPOLLIN | EPOLLOUT);
  peer.is_closed = peer.is_closed || !watched;
}

void Announcer::serve(Peer& peer, std::uint32_t events) {
  char ignored[256];  // peers send nothing
  if ((events & ~EPOLLOUT) != 0) {
    const auto size = ::recv(peer.socket.get(), ignored, sizeof ignored, MSG_DONTWAIT);
    peer.is_closed = size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
  }
  if (!peer.is_closed && !peer.queued.empty()) write(peer);
  remove_closed();
}

void Announcer::remove_closed() {
  std::erase_if(peers_, [](const auto& peer) { return peer->is_closed; });
}

Status send_at_once(const std::string& uri, const Message& message) {
  auto parsed = HC_TRY(parse_uri(uri));
  if (parsed.scheme != "unix") return Error{Code::Invalid, uri + ": replies need a unix: URI"};
  parsed.options = {{"keep", "latest"}};  // never block
  auto sink = HC_TRY(open_sink(parsed));
  auto sent = sink->send(message);
  sink->abandon();
  return sent;
}

}  // namespace hc::internal
