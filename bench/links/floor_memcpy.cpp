// SPDX-License-Identifier: Apache-2.0
// Floor: one memcpy of the message within a process, which any transport that copies must beat to
// be believed. Prints a line of JSON as ping does, and images as written, copied and read.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "pattern.h"

int main(int argc, char** argv) {
  const std::size_t bytes = argc > 1 ? std::stoul(argv[1]) : 96;
  const double seconds = argc > 2 ? std::stod(argv[2]) : 0.25;
  const std::size_t batch = std::max(std::size_t{1}, 100'000 / bytes);
  std::vector<std::byte> from(bytes), to(bytes);
  using Clock = std::chrono::steady_clock;
  auto since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };

  std::vector<double> copies;
  for (auto begin = Clock::now(); since(begin) < seconds / 2;) {
    auto start = Clock::now();
    for (std::size_t i = 0; i < batch; ++i) {
      std::memcpy(to.data(), from.data(), bytes);
      asm volatile("" : : "r"(to.data()), "r"(from.data()) : "memory");
    }
    copies.push_back(since(start) * 1e6 / static_cast<double>(batch));
  }
  std::sort(copies.begin(), copies.end());

  std::uint64_t number = 0;
  auto begin = Clock::now();
  while (since(begin) < seconds / 2) {
    bench::write_pattern(from.data(), bytes, number++);
    std::memcpy(to.data(), from.data(), bytes);
    if (!bench::read_pattern(to)) return 1;
  }
  std::printf(R"({"median_us": %.4f, "p99_us": %.4f, "per_second": %.3f, "lost": 0})"
              "\n",
              copies[copies.size() / 2], copies[copies.size() * 99 / 100],
              static_cast<double>(number) / since(begin));
}
