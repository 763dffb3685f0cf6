// SPDX-License-Identifier: Apache-2.0
#pragma once
// Waits for any number of sources: busy-waits for those in shared memory, then sleeps. Used on one
// thread.

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

/// Waits for sources repeatedly. Set-up is repeated only when the set of sources changes.
///
///     WaitSet waits(stop_descriptor());
///     while (take_all(sources) == Got::Nothing)
///       if (auto ready = waits.wait(sources); !ready) return ready.error();
class WaitSet {
 public:
  /// @param stop  descriptor that ends waits when it is readable; -1: none.
  explicit WaitSet(int stop = -1);
  ~WaitSet();
  WaitSet(const WaitSet&) = delete;
  WaitSet& operator=(const WaitSet&) = delete;

  /// Waits until one of `sources` may have a message, or one of `descriptors` is readable; false
  /// after `timeout`. Each source must have returned Nothing since the last wait for it.
  ///
  /// Errors: Stopped, System. Cost: one system call, and one for each of `descriptors`; if the set
  /// of sources has changed, also a few per source, and memory.
  Result<bool> wait(std::span<Source* const> sources, std::span<const int> descriptors,
                    std::chrono::nanoseconds timeout);
  Result<bool> wait(std::span<Source* const> sources,
                    std::chrono::nanoseconds timeout = std::chrono::nanoseconds(-1)) {
    return wait(sources, {}, timeout);
  }

  /// Whether the last wait slept and was ended by this source.
  [[nodiscard]] bool was_woken_by(const Source& source) const;

  /// Whether the last wait took at most about a microsecond, since a message was ready. A caller
  /// that has read the clock before it need not read it again.
  [[nodiscard]] bool was_short() const { return was_short_; }

  [[nodiscard]] int stop() const { return stop_; }

 private:
  using Clock = std::chrono::steady_clock;

  Status prepare(std::span<Source* const> sources);
  Status watch(int descriptor, std::uint32_t events, std::uint64_t what);
  Result<bool> sleep(std::chrono::nanoseconds timeout);

  int stop_;
  Descriptor poll_;                       // an epoll instance
  std::vector<std::uint64_t> watched_;    // numbers of the sources in it
  bool never_sleeps_ = false;             // one is a file, which is always readable
  std::vector<std::uint64_t> woken_by_;   // the sources whose events ended the last sleep
  std::unique_ptr<internal::Spin> spin_;  // busy-waits before sleeping
  bool was_short_ = false;
};

}  // namespace hc
