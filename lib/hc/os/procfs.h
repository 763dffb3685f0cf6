// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the kernel says of a process and all that descends from it (/proc).

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <vector>

namespace hc {

/// All that descends from a process, without itself. Cost: some system calls for each of them.
std::vector<pid_t> descendants(pid_t process);

/// What processes have used, together.
struct Usage {
  std::chrono::nanoseconds processor{0};  ///< with what those children used that have ended
  std::uint64_t memory = 0;               ///< their part of what they share (PSS) [byte]
  bool is_stopped = false;                ///< one of them, by a signal or a debugger
  bool is_traced = false;                 ///< one of them is stopped in a debugger
};

/// @param with_memory  whether `memory` is wanted, which takes the kernel longer than the rest.
Usage usage_of(const std::vector<pid_t>& processes, bool with_memory);

}  // namespace hc
