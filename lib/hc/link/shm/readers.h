// SPDX-License-Identifier: Apache-2.0
#pragma once
// The readers of a publisher of shared memory: lets them in, and notices when they leave or die,
// on the thread that serves links, whatever the publisher does meanwhile. Internal.

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include <hc/link/policy.h>
#include <hc/link/shm/greeting.h>
#include <hc/link/shm/layout.h>
#include <hc/link/stream/remarks.h>
#include <hc/os/event.h>
#include <hc/os/reactor.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// One reader, as its publisher sees it.
struct ShmReader {
  Descriptor socket;
  Hello hello;              ///< what it has said
  std::uint64_t begin = 0;  ///< position of its first message
  std::uint64_t seen = 0;   ///< how far it said that it is, at most; of the publisher's thread
  std::uint32_t woken = 0;  ///< what `armed` said when it was woken last
  Patience patience;        ///< of a publisher that waits for it, on whose thread it is used
  Watch watch;              ///< last, so that it ends first

  /// Whether it has said what it is; a stranger has not.
  [[nodiscard]] bool is_known() const { return hello.page.data() != nullptr; }
  [[nodiscard]] const ReaderPage& page() const {
    return *reinterpret_cast<const ReaderPage*>(hello.page.data());
  }
  [[nodiscard]] bool left() const {
    return page().cursor.load(std::memory_order_acquire) == ReaderPage::kLeft;
  }
  /// The position that it takes next, as far as that can be: whatever its page says, at least where
  /// it has been and at most what has been published.
  [[nodiscard]] std::uint64_t cursor(std::uint64_t published) {
    seen = std::max(seen, std::min(page().cursor.load(std::memory_order_acquire), published));
    return seen;
  }
};

class ShmReaders {
 public:
  /// @param head  of `memory`; says where a reader that comes begins.
  /// @param keep  for readers that do not say. @param patience  with each.
  static Result<std::unique_ptr<ShmReaders>> make(ListeningSocket socket,
                                                  const SharedMemory& memory, std::uint64_t keep,
                                                  const Patience& patience);
  ~ShmReaders();
  ShmReaders(const ShmReaders&) = delete;
  ShmReaders& operator=(const ShmReaders&) = delete;

  /// Those there are, as of the last refresh(). On the publisher's thread.
  [[nodiscard]] const std::vector<std::shared_ptr<ShmReader>>& current() const { return current_; }

  /// Whether some have come or left since, or something is to be logged.
  ///
  /// A reader that can hold a slot by now has come before the caller's last fence ("hold"), and is
  /// seen here.
  [[nodiscard]] bool changed() const { return changed_.load(std::memory_order_relaxed); }
  void refresh();
  /// What is to be logged, since this was last called.
  [[nodiscard]] Remarks& remarks() { return remarks_; }

  // Of those there are, on the publisher's thread; `published` is the position it publishes next.

  /// The position below which every reader that loses nothing has taken all, but for those that
  /// have been given up.
  [[nodiscard]] std::uint64_t taken_by_all(std::uint64_t published);
  /// The position below which no reader wants anything any more.
  [[nodiscard]] std::uint64_t wanted_by_none(std::uint64_t published) const;
  /// Whom a publisher waits for: the slowest of those that lose nothing, if it has not taken all,
  /// else anybody who holds something; null when it is nobody, but for those that it has given up.
  [[nodiscard]] std::shared_ptr<ShmReader> blocker(std::uint64_t published);
  /// Whether there are some that have been given up.
  [[nodiscard]] bool have_given_up() const;
  /// Nobody is waited for any more.
  void end_waits();
  /// Wakes those who sleep; whether there were any.
  bool wake();

  /// Readable when some have come or left, or something is to be logged, since refresh().
  [[nodiscard]] int event() const { return event_.descriptor(); }

 private:
  ShmReaders(ListeningSocket socket, Event event, Descriptor read_only)
      : socket_(std::move(socket)), event_(std::move(event)), read_only_(std::move(read_only)) {}

  void accept_all();
  void hear(ShmReader& reader);
  void let_go(ShmReader& reader);
  [[nodiscard]] bool is_full_of(bool known) const;
  void note_change(const ShmReader& reader);
  void tell_change(const ShmReader& reader);
  void remark(std::string line);
  bool is_given_up(ShmReader& reader, std::uint64_t published);

  ListeningSocket socket_;
  Event event_;
  Descriptor read_only_;
  Remarks remarks_;
  const Head* head_ = nullptr;
  std::uint64_t bytes_ = 0, keep_ = 0;
  Patience patience_;
  std::vector<std::shared_ptr<ShmReader>> current_;
  std::atomic<bool> changed_{false};

  std::mutex mutex_;                             // of what follows
  std::vector<std::shared_ptr<ShmReader>> all_;  // who is connected, in the order of coming
  bool ending_ = false;

  Watch watch_;
};

}  // namespace hc::internal
