// SPDX-License-Identifier: Apache-2.0
#pragma once
// One wait for any number of sources: looks for a while at those whose messages come in memory,
// then sleeps once. Of one thread.

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <hc/link/link.h>
#include <hc/os/descriptor.h>

namespace hc {

namespace internal {
class Spin;
}

/// Waits for sources, again and again. What a wait needs is prepared once, and again only when the
/// sources are others than the last time.
///
///     WaitSet waits(stop_descriptor());
///     while (take_all(sources) == Got::Nothing)
///       if (auto ready = waits.wait(sources); !ready) return ready.error();
class WaitSet {
 public:
  /// @param stop  descriptor that is readable when waiting is to end; -1: none.
  explicit WaitSet(int stop = -1);
  ~WaitSet();
  WaitSet(const WaitSet&) = delete;
  WaitSet& operator=(const WaitSet&) = delete;

  /// Waits until one of `sources` may have something to take, or one of `descriptors` is readable;
  /// false when `timeout` has passed. Every source has given Nothing since it was last waited for.
  ///
  /// Errors: Stopped, System. Cost: one system call, one more for each of `descriptors`, and some
  /// for each source when they are others than the last time. Allocates only then.
  Result<bool> wait(std::span<Source* const> sources, std::span<const int> descriptors,
                    std::chrono::nanoseconds timeout);
  Result<bool> wait(std::span<Source* const> sources,
                    std::chrono::nanoseconds timeout = std::chrono::nanoseconds(-1)) {
    return wait(sources, {}, timeout);
  }

  /// Whether the last wait slept, and a descriptor of this source ended it.
  [[nodiscard]] bool was_woken_by(const Source& source) const;

  /// Whether the last wait took about a microsecond at most, since a message was in memory already.
  /// A caller that has read the clock before it need not read it again.
  [[nodiscard]] bool was_short() const { return was_short_; }

  /// The descriptor that ends a wait.
  [[nodiscard]] int stop() const { return stop_; }

 private:
  using Clock = std::chrono::steady_clock;

  Status prepare(std::span<Source* const> sources);
  Status watch(int descriptor, std::uint32_t events, std::uint64_t what);
  Result<bool> sleep(std::chrono::nanoseconds timeout);

  int stop_;
  Descriptor poll_;                       // an epoll instance of all that is waited for
  std::vector<std::uint64_t> watched_;    // the sources in it, by their numbers
  bool never_sleeps_ = false;             // one is a file, which is always readable
  std::vector<std::uint64_t> woken_by_;   // the sources whose events ended the last sleep
  std::unique_ptr<internal::Spin> spin_;  // before it sleeps
  bool was_short_ = false;
};

}  // namespace hc
