// SPDX-License-Identifier: Apache-2.0
#pragma once
// The readers of a publisher of shared memory. The reactor's thread accepts them and notices when
// they leave or die, whatever the publisher's thread does. Internal.

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

/// A reader, as seen by its publisher.
struct ShmReader {
  Descriptor socket;
  Hello hello;
  std::uint64_t begin = 0;  ///< position of its first message
  std::uint64_t seen = 0;   ///< the largest cursor seen, by the publisher's thread
  std::uint32_t woken = 0;  ///< the value of `armed` when it was last woken
  Patience patience;        ///< of the publisher with this reader, used by its thread
  Watch watch;              ///< last, so that it ends first

  /// Whether it has sent its Hello.
  [[nodiscard]] bool is_known() const { return hello.page.data() != nullptr; }
  [[nodiscard]] const ReaderPage& page() const {
    return *reinterpret_cast<const ReaderPage*>(hello.page.data());
  }
  [[nodiscard]] bool left() const {
    return page().cursor.load(std::memory_order_acquire) == ReaderPage::kLeft;
  }
  /// The next position that it takes, limited to plausible values: never decreasing, and at most
  /// `published`.
  [[nodiscard]] std::uint64_t cursor(std::uint64_t published) {
    seen = std::max(seen, std::min(page().cursor.load(std::memory_order_acquire), published));
    return seen;
  }
};

class ShmReaders {
 public:
  /// @param memory  its head says where a new reader begins.
  /// @param keep  for readers that do not request a number. @param patience  with each reader.
  static Result<std::unique_ptr<ShmReaders>> make(ListeningSocket socket,
                                                  const SharedMemory& memory, std::uint64_t keep,
                                                  const Patience& patience);
  ~ShmReaders();
  ShmReaders(const ShmReaders&) = delete;
  ShmReaders& operator=(const ShmReaders&) = delete;

  /// The readers, as of the last refresh(). On the publisher's thread.
  [[nodiscard]] const std::vector<std::shared_ptr<ShmReader>>& current() const { return current_; }

  /// Whether readers have come or left since, or there are lines to log.
  ///
  /// A reader that may hold a slot was added before the caller's last fence ("hold"), so this is
  /// true.
  [[nodiscard]] bool changed() const { return changed_.load(std::memory_order_relaxed); }
  void refresh();
  /// Lines to be logged by the publisher's thread.
  [[nodiscard]] Remarks& remarks() { return remarks_; }

  // About the current readers, on the publisher's thread. `published` is the next position.

  /// All positions below have been taken by every lossless reader (keep=all) not given up.
  [[nodiscard]] std::uint64_t taken_by_all(std::uint64_t published);
  /// No reader needs any position below.
  [[nodiscard]] std::uint64_t wanted_by_none(std::uint64_t published) const;
  /// The reader to wait for: the slowest lossless one, if it has not taken everything, else any
  /// that holds a slot. Null if there is none, apart from those given up.
  [[nodiscard]] std::shared_ptr<ShmReader> blocker(std::uint64_t published);
  /// Whether any reader has been given up.
  [[nodiscard]] bool have_given_up() const;
  /// Ends the waits of all Patiences.
  void end_waits();
  /// Wakes sleeping readers; whether there were any.
  bool wake();

  /// Readable when readers have come or left, or there are lines to log, since refresh().
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

  std::mutex mutex_;                             // of the next two
  std::vector<std::shared_ptr<ShmReader>> all_;  // in the order in which they connected
  bool ending_ = false;

  Watch watch_;
};

}  // namespace hc::internal
