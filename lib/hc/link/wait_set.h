// SPDX-License-Identifier: Apache-2.0
#pragma once
// One wait for any number of sources and descriptors: polls shared memory for a while, then sleeps
// once. Used by one thread.

#include <algorithm>
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

/// Waits for sources and descriptors, repeatedly. It prepares for a wait only when these are not
/// the same as before.
///
///     WaitSet waits(stop_descriptor());
///     while (take_all(sources) == Got::Nothing)
///       if (auto ready = waits.wait(sources); !ready) return ready.error();
class WaitSet {
 public:
  /// @param stop  ends waits when it is readable; -1: none.
  explicit WaitSet(int stop = -1);
  ~WaitSet();
  WaitSet(const WaitSet&) = delete;
  WaitSet& operator=(const WaitSet&) = delete;

  /// Waits until one of `sources` may have something to take, or one of `descriptors` is readable;
  /// false when `timeout` has passed. Every source has given Nothing since it was last waited for.
  /// A descriptor may be closed between two waits, and another opened with the same number.
  ///
  /// Errors: Stopped, System. Cost: one system call; one more for each descriptor every 10 ms; some
  /// for each source and descriptor, and allocations, when they are not those of the last wait.
  Result<bool> wait(std::span<Source* const> sources, std::span<const int> descriptors,
                    std::chrono::nanoseconds timeout);
  Result<bool> wait(std::span<Source* const> sources,
                    std::chrono::nanoseconds timeout = std::chrono::nanoseconds(-1)) {
    return wait(sources, {}, timeout);
  }

  /// Whether the last wait slept, and a descriptor of this source ended it.
  [[nodiscard]] bool was_woken_by(const Source& source) const { return was_woken(source.number_); }
  /// Whether the last wait looked at descriptors: not if it found a message in memory.
  [[nodiscard]] bool has_looked() const { return has_looked_; }
  /// Whether the last wait found this one of its `descriptors` readable, or failed; if it looked.
  [[nodiscard]] bool was_readable(int descriptor) const { return was_woken(number_of(descriptor)); }

  /// Whether the last wait took no more than about a microsecond, since a message was in memory. A
  /// caller that read the clock before it need not read it again.
  [[nodiscard]] bool was_short() const { return was_short_; }

  [[nodiscard]] int stop() const { return stop_; }

 private:
  using Clock = std::chrono::steady_clock;

  static constexpr std::uint64_t kDescriptors = std::uint64_t{1} << 63;  // beyond all sources
  static std::uint64_t number_of(int descriptor) {
    return kDescriptors | static_cast<std::uint32_t>(descriptor);
  }
  [[nodiscard]] bool was_woken(std::uint64_t number) const {
    return std::find(woken_by_.begin(), woken_by_.end(), number) != woken_by_.end();
  }
  Status prepare(std::span<Source* const> sources);
  Status watch(std::span<const int> descriptors);
  Status watch(int descriptor, std::uint32_t events, std::uint64_t number);
  Result<bool> sleep(std::chrono::nanoseconds timeout);

  int stop_;
  Descriptor poll_;                       // an epoll instance for everything that is waited for
  std::vector<std::uint64_t> sources_;    // in it, by their numbers
  std::vector<int> descriptors_;          // of the caller, in it
  Clock::time_point watched_at_;          // when these were last added to it
  std::vector<std::uint64_t> files_;      // not in it: they are always readable
  std::vector<std::uint64_t> woken_by_;   // numbers of sources and descriptors
  std::unique_ptr<internal::Spin> spin_;  // before it sleeps
  bool was_short_ = false, has_looked_ = false;
};

}  // namespace hc
