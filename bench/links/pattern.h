// SPDX-License-Identifier: Apache-2.0
#pragma once
// What messages hold where all bytes are written and read: word i of message n is n + i. The sum
// of all words shows the reader that each byte came. Compiled for wider registers where they are,
// so that the memory is measured, not the loop.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace bench {

/// The number of the last message of a run.
inline constexpr std::uint64_t kLast = std::uint64_t{1} << 62;

// Sanitizers and function multiversioning do not go together.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HC_BENCH_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define HC_BENCH_WIDE
#endif

HC_BENCH_WIDE inline void write_pattern(std::byte* bytes, std::size_t size, std::uint64_t number) {
  for (std::size_t i = 0; i < size / 8; ++i) {
    std::uint64_t word = number + i;
    std::memcpy(bytes + 8 * i, &word, 8);
  }
  std::memset(bytes + size / 8 * 8, static_cast<int>(number & 0xff), size % 8);
}

HC_BENCH_WIDE inline std::uint64_t sum_words(const std::byte* bytes, std::size_t size) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < size / 8; ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + 8 * i, 8);
    sum += word;
  }
  return sum;
}

inline std::uint64_t first_word(std::span<const std::byte> bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes.data(), 8);
  return word;
}

/// Reads all bytes; whether they are what write_pattern() wrote.
inline bool read_pattern(std::span<const std::byte> bytes) {
  const std::uint64_t words = bytes.size() / 8, number = first_word(bytes);
  bool good = sum_words(bytes.data(), bytes.size()) == words * number + words * (words - 1) / 2;
  for (std::size_t i = 8 * words; i < bytes.size(); ++i)
    good &= bytes[i] == static_cast<std::byte>(number & 0xff);
  return good;
}

}  // namespace bench
