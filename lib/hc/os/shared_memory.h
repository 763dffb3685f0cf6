// SPDX-License-Identifier: Apache-2.0
#pragma once
// Anonymous memory that processes share: it has no name, cannot change its size, and ends with
// the last process that maps it.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hc/os/descriptor.h>

namespace hc {

/// A word that several processes see; exactly one of them writes it.
template <typename T>
using SharedWord = std::atomic<T>;
static_assert(SharedWord<std::uint64_t>::is_always_lock_free);
static_assert(SharedWord<std::uint32_t>::is_always_lock_free);

constexpr std::uint64_t kPageBytes = 4096;

/// A mapping of shared memory.
class SharedMemory {
 public:
  /// New memory of `bytes`, zero, to be written here and read by others. Only the first `reserved`
  /// bytes have pages yet; writing behind them is for who called reserve().
  static Result<SharedMemory> make(std::uint64_t bytes, std::uint64_t reserved);

  /// Memory of somebody else, read-only. `bytes` is how large it has to be.
  ///
  /// Errors: Malformed: it is no sealed memory of that size, so that reading it could kill us.
  static Result<SharedMemory> map(Descriptor descriptor, std::uint64_t bytes);

  SharedMemory() = default;
  SharedMemory(SharedMemory&& other) noexcept
      : descriptor_(std::move(other.descriptor_)),
        data_(std::exchange(other.data_, nullptr)),
        bytes_(std::exchange(other.bytes_, 0)),
        reserved_(std::exchange(other.reserved_, 0)) {}
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  /// Gives the bytes below `end` pages of their own, for good. Cost: a system call where they have
  /// none yet. Errors: System (the host is out of memory).
  Status reserve(std::uint64_t end);

  /// Another descriptor of the memory, which can be read alone. Errors: System.
  [[nodiscard]] Result<Descriptor> read_only() const;

  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::uint64_t size() const { return bytes_; }

 private:
  Descriptor descriptor_;
  std::byte* data_ = nullptr;
  std::uint64_t bytes_ = 0, reserved_ = 0;
};

/// Lets processes see each other's stores in order at the cost of one side alone: who is seldom in
/// need of it says order_everywhere(), and who has said allow_ordering() needs no fence of its own.
/// Both tell whether the kernel can do that.
bool allow_ordering();
bool can_order_everywhere();
/// A fence for every thread that runs now, of processes that allow it. Cost: 1 to 10 µs.
void order_everywhere();

/// Sleeps as long as `word` is `value`, at most `timeout`; may wake early. The word may be in
/// memory that is mapped read-only.
void futex_wait(const SharedWord<std::uint32_t>& word, std::uint32_t value,
                std::chrono::nanoseconds timeout);

/// Wakes everybody who sleeps on `word`.
void futex_wake(const SharedWord<std::uint32_t>& word);

}  // namespace hc
