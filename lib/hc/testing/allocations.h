// SPDX-License-Identifier: Apache-2.0
#pragma once
// What this thread has had allocated. It takes the place of operator new, so one file of a program
// includes it.

#include <cstdint>
#include <cstdlib>
#include <new>

namespace hc {

struct Allocations {
  std::int64_t count = 0, bytes = 0;
};
inline thread_local Allocations allocations;

}  // namespace hc

// Not inlined: compilers then take what `new` gave for the wrong end of free(). ThreadSanitizer has
// its own, which cannot be replaced; nothing is counted there.
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
