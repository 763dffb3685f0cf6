// SPDX-License-Identifier: Apache-2.0
#pragma once
// Counts the allocations of the current thread by replacing operator new; to be included in one
// file of a program.

#include <cstdint>
#include <cstdlib>
#include <new>

namespace hc {

struct Allocations {
  std::int64_t count = 0, bytes = 0;
};
inline thread_local Allocations allocations;

}  // namespace hc

// Not inlined, or compilers report mismatched free(). ThreadSanitizer's operator new cannot be
// replaced; nothing is counted there.
#if !defined(__has_feature)
#define __has_feature(feature) 0
#endif
#if !__has_feature(thread_sanitizer)
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto at = static_cast<std::size_t>(alignment);
  ++hc::allocations.count;
  hc::allocations.bytes += static_cast<std::int64_t>(size);
  if (void* memory = std::aligned_alloc(at, (size + at - 1) / at * at); memory != nullptr)
    return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  return operator new (size, std::align_val_t{16});
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
#endif
