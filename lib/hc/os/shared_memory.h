// SPDX-License-Identifier: Apache-2.0
#pragma once
// Anonymous shared memory of fixed size; it has no name and is freed with its last mapping.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hc/os/descriptor.h>

namespace hc {

/// A word in shared memory; exactly one process writes it.
template <typename T>
using SharedWord = std::atomic<T>;
static_assert(SharedWord<std::uint64_t>::is_always_lock_free);
static_assert(SharedWord<std::uint32_t>::is_always_lock_free);

constexpr std::uint64_t kPageBytes = 4096;

class SharedMemory {
 public:
  /// New zeroed memory, writable here, read-only for others. Only the first `reserved` bytes have
  /// pages; call reserve() before writing beyond them.
  static Result<SharedMemory> make(std::uint64_t bytes, std::uint64_t reserved);

  /// Maps memory received from another process read-only. `bytes` is its required size.
  ///
  /// Errors: Malformed (not sealed or of another size: reading it could raise SIGBUS).
  static Result<SharedMemory> map(Descriptor descriptor, std::uint64_t bytes);

  SharedMemory() = default;
  SharedMemory(SharedMemory&& other) noexcept
      : descriptor_(std::move(other.descriptor_)),
        data_(std::exchange(other.data_, nullptr)),
        bytes_(std::exchange(other.bytes_, 0)),
        reserved_(std::exchange(other.reserved_, 0)) {}
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  /// Allocates pages for the bytes below `end`, permanently. Cost: a system call if they have none
  /// yet. Errors: System (the host is out of memory).
  Status reserve(std::uint64_t end);

  /// A read-only descriptor of the memory. Errors: System.
  [[nodiscard]] Result<Descriptor> read_only() const;

  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::uint64_t size() const { return bytes_; }

 private:
  Descriptor descriptor_;
  std::byte* data_ = nullptr;
  std::uint64_t bytes_ = 0, reserved_ = 0;
};

/// Asymmetric memory barriers (membarrier): a process that has called allow_ordering() needs no
/// fence on its fast path, since the other side calls order_everywhere() on its slow path. The
/// first two return whether the kernel supports this.
bool allow_ordering();
bool can_order_everywhere();
/// A fence for all running threads of processes that allow it. Cost: 1 to 10 µs.
void order_everywhere();

/// Sleeps while `word` equals `value`, at most `timeout`; may wake early. The word may be in memory
/// mapped read-only.
void futex_wait(const SharedWord<std::uint32_t>& word, std::uint32_t value,
                std::chrono::nanoseconds timeout);

/// Wakes all sleepers on `word`.
void futex_wake(const SharedWord<std::uint32_t>& word);

}  // namespace hc
