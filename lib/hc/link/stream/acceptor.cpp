// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/acceptor.h>

#include <hc/link/stream/remarks.h>

#include <sys/eventfd.h>

#include <algorithm>

namespace hc::internal {
namespace {

bool has_left(const Descriptor& peer) {
  pollfd polled{peer.get(), 0, 0};
  return ::poll(&polled, 1, 0) > 0;  // of error or hang-up
}

}  // namespace

Result<std::unique_ptr<Acceptor>> Acceptor::make(ListeningSocket socket, std::size_t room) {
  auto event = system_call("eventfd", "", [] { return ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC); });
  if (!event) return event.error();
  std::unique_ptr<Acceptor> acceptor(new Acceptor(std::move(socket), Descriptor(*event), room));
  auto watch = Watch::make(acceptor->socket_.descriptor.get(), [self = acceptor.get()](auto) {
    std::lock_guard lock(self->mutex_);
    self->accept_all();
  });
  if (!watch) return watch.error();
  acceptor->watch_ = std::move(*watch);
  acceptor->watching_ = acceptor->watch_.get();
  if (auto wanted = acceptor->watching_->want(EPOLLIN); !wanted) return wanted.error();
  return acceptor;
}

std::vector<Descriptor> Acceptor::take(std::size_t room) {
  std::lock_guard lock(mutex_);
  room_ = room;
  accept_all();
  eventfd_t count = 0;
  if (!newcomers_.empty()) ::eventfd_read(arrived_.get(), &count);
  has_news_ = !remarks_.empty();
  room_ -= newcomers_.size();  // which the caller has from now on
  return std::exchange(newcomers_, {});
}

void Acceptor::accept_all() {
  // No more than anybody wants to read: others may have us say much.
  auto remark = [this](Severity, std::string_view line) {
    if (remarks_.size() < Remarks::kMost) remarks_.emplace_back(line);
  };
  auto has_room = [this] {
    if (newcomers_.size() >= room_) std::erase_if(newcomers_, has_left);
    return newcomers_.size() < room_;
  };
  socket_.accept_all(*watching_, remark, has_room, [this](Descriptor peer) {
    newcomers_.push_back(std::move(peer));
    return Status();
  });
  if (!newcomers_.empty()) ::eventfd_write(arrived_.get(), 1);
  has_news_ = !newcomers_.empty() || !remarks_.empty();
}

std::vector<std::string> Acceptor::take_remarks() {
  std::lock_guard lock(mutex_);
  has_news_ = !newcomers_.empty();
  return std::exchange(remarks_, {});
}

}  // namespace hc::internal
