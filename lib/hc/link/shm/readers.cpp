// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/readers.h>

#include <sys/socket.h>

#include <algorithm>
#include <iterator>

#include <hc/link/shm/crash_point.h>
#include <hc/os/peer_user.h>

namespace hc::internal {
Result<std::unique_ptr<ShmReaders>> ShmReaders::make(ListeningSocket socket,
                                                     const SharedMemory& memory, std::uint64_t keep,
                                                     const Patience& patience) {
  auto event = HC_TRY(Event::make());
  auto read_only = HC_TRY(memory.read_only());
  std::unique_ptr<ShmReaders> readers(
      new ShmReaders(std::move(socket), std::move(event), std::move(read_only)));
  readers->head_ = reinterpret_cast<const Head*>(memory.data());
  readers->bytes_ = memory.size();
  readers->keep_ = keep;
  readers->patience_ = patience;
  readers->socket_.admit = [](int peer) -> Status {
    auto own = check_own(unix_peer_user(peer), "refused a reader of ");
    if (!own) refuse(peer, "another user");
    return own;
  };
  HC_TRY(readers->watch_.start(readers->socket_.descriptor.get(),
                               [all = readers.get()](auto) { all->accept_all(); }));
  HC_TRY(readers->watch_.want(EPOLLIN));
  return readers;
}

ShmReaders::~ShmReaders() {
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
  }
  watch_.end();
  std::vector<std::shared_ptr<ShmReader>> all;  // destroyed without the lock, with their watches
  std::lock_guard lock(mutex_);
  all.swap(all_);
  all.insert(all.end(), current_.begin(), current_.end());
  current_.clear();
}

/// On the reactor's thread, for the log of the publisher's.
void ShmReaders::remark(std::string line) {
  remarks_.add(std::move(line));
  std::lock_guard lock(mutex_);
  changed_.store(true, std::memory_order_seq_cst);
  event_.raise();
}

void ShmReaders::accept_all() {
  auto log = [this](Level, std::string_view line) { remark(std::string(line)); };
  auto has_room = [] { return true; };
  socket_.accept_all(watch_, log, has_room, [this](ConnectedSocket peer) -> Status {
    auto reader = std::make_shared<ShmReader>();
    HC_TRY(reader->watch.start(peer.get(), [this, each = reader.get()](auto events) {
      if ((events & (EPOLLHUP | EPOLLERR)) != 0)
        let_go(*each);
      else if (!each->is_known())
        hear(*each);
      else
        note_change(*each);  // it takes no more messages, but may hold some
    }));
    reader->socket = std::move(peer.descriptor);
    reader->patience = patience_;
    std::shared_ptr<ShmReader> silent;
    {
      std::lock_guard lock(mutex_);
      if (ending_) return {};
      if (is_full_of(false)) {  // peers that send no Hello must not lock others out
        auto first = std::find_if(all_.begin(), all_.end(),
                                  [](const auto& each) { return !each->is_known(); });
        silent = std::move(*first);
        all_.erase(first);
      }
      all_.push_back(reader);
    }
    return reader->watch.want(EPOLLIN);
  });
}

/// Whether there are kMostReaders that have, or have not, sent their Hello.
bool ShmReaders::is_full_of(bool known) const {
  auto count = std::count_if(all_.begin(), all_.end(),
                             [&](const auto& each) { return each->is_known() == known; });
  return static_cast<std::size_t>(count) == kMostReaders;
}

/// Receives the Hello of a peer, and answers.
void ShmReaders::hear(ShmReader& reader) {
  auto hello = take_hello(reader.socket.get(), keep_);
  HC_CRASH_POINT("publisher greeted");
  std::string why;
  if (!hello) why = hello.error().detail;
  {
    std::lock_guard lock(mutex_);
    if (ending_) return;
    if (why.empty() && is_full_of(true))
      why = "it has " + std::to_string(kMostReaders) + " readers already";
    if (why.empty()) {
      reader.hello = std::move(*hello);
      // Before `published` is read: a publisher that has published more by then sees the change
      // before it withdraws any message for this reader.
      changed_.store(true, std::memory_order_relaxed);
      order_everywhere();
      reader.begin = reader.seen = head_->published.load(std::memory_order_acquire);
    }
  }
  if (!why.empty()) {
    remark("refused a reader: " + why);
    refuse(reader.socket.get(), why);
    let_go(reader);
    return;
  }
  HC_CRASH_POINT("publisher knows reader");
  // Edge-triggered: the reader first shuts down its direction, and closes later.
  static_cast<void>(reader.watch.want(EPOLLRDHUP | EPOLLET));
  Offer offer{reader.begin, reader.hello.keep, {}};
  if (!answer(reader.socket.get(), offer, bytes_, read_only_.get())) return let_go(reader);
  HC_CRASH_POINT("publisher answered");
  note_change(reader);
}

/// Removes a reader that has left or died, which looks the same: its slots are free.
void ShmReaders::let_go(ShmReader& reader) {
  static_cast<void>(reader.watch.want(0));
  std::shared_ptr<ShmReader> owner;  // destroyed without the lock
  std::lock_guard lock(mutex_);
  auto found = std::find_if(all_.begin(), all_.end(),
                            [&](const auto& each) { return each.get() == &reader; });
  if (found == all_.end()) return;
  owner = std::move(*found);
  all_.erase(found);
  if (reader.is_known()) tell_change(reader);
}

void ShmReaders::note_change(const ShmReader& reader) {
  std::lock_guard lock(mutex_);
  tell_change(reader);
}

/// Requires the lock, so that refresh() sees both the flag and the event.
void ShmReaders::tell_change(const ShmReader& reader) {
  changed_.store(true, std::memory_order_seq_cst);
  event_.raise();
  futex_wake(reader.page().progress);  // the publisher may wait for room from this reader
}

void ShmReaders::refresh() {
  std::vector<std::shared_ptr<ShmReader>>
      known;  // then the former ones, destroyed without the lock
  std::lock_guard lock(mutex_);
  changed_.store(false, std::memory_order_relaxed);
  event_.clear();
  std::copy_if(all_.begin(), all_.end(), std::back_inserter(known),
               [](const auto& reader) { return reader->is_known(); });
  current_.swap(known);
}

/// Whether a reader was given up and has taken nothing since.
bool ShmReaders::is_given_up(ShmReader& reader, std::uint64_t published) {
  return reader.patience.is_over() && reader.patience.is_over(reader.cursor(published));
}

bool ShmReaders::have_given_up() const {
  return std::any_of(current_.begin(), current_.end(),
                     [](const auto& reader) { return reader->patience.is_over(); });
}

void ShmReaders::end_waits() {
  for (const auto& reader : current_) reader->patience.end();
}

std::uint64_t ShmReaders::taken_by_all(std::uint64_t published) {
  std::uint64_t taken = published;
  for (const auto& reader : current_)
    if (reader->hello.keep == 0 && !is_given_up(*reader, published))
      taken = std::min(taken, reader->cursor(published));
  return taken;
}

std::uint64_t ShmReaders::wanted_by_none(std::uint64_t published) const {
  std::uint64_t end = published;
  for (const auto& reader : current_) {
    auto cursor = reader->cursor(published);
    if (reader->hello.keep > 0 && published - cursor > reader->hello.keep)
      cursor = published - reader->hello.keep;
    end = std::min(end, cursor);
  }
  return end;
}

std::shared_ptr<ShmReader> ShmReaders::blocker(std::uint64_t published) {
  std::shared_ptr<ShmReader> slowest, holder;
  for (const auto& reader : current_) {
    if (is_given_up(*reader, published)) continue;
    auto cursor = reader->cursor(published);
    if (reader->hello.keep == 0 && cursor < published &&
        (slowest == nullptr || cursor < slowest->cursor(published)))
      slowest = reader;
    for (const auto& held : reader->page().held)
      if (held.load(std::memory_order_acquire) != 0) holder = reader;
  }
  return slowest != nullptr ? slowest : holder;
}

bool ShmReaders::wake() {
  bool any = false;
  for (const auto& reader : current_) {
    auto armed = reader->page().armed.load(std::memory_order_relaxed);
    if (armed == 0 || armed == reader->woken) continue;
    reader->woken = armed;
    any = true;
    [[maybe_unused]] const auto size = ::write(reader->hello.wakes.get(), "!", 1);
  }
  return any;
}

}  // namespace hc::internal
