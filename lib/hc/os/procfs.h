// SPDX-License-Identifier: Apache-2.0
#pragma once
// Resource usage of a process and its descendants (/proc).

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <vector>

namespace hc {

/// All descendants of a process, without itself. Cost: a few system calls per process.
std::vector<pid_t> descendants(pid_t process);

/// The resources used by processes, summed.
struct Usage {
  std::chrono::nanoseconds processor{0};  ///< CPU time, with that of children that have ended
  /// For how long the first one's first thread has been runnable without running.
  std::chrono::nanoseconds waited{0};
  std::uint64_t memory = 0;  ///< proportional set size (PSS) [byte]
  bool is_stopped = false;   ///< one is stopped by a signal or a debugger
  bool is_traced = false;    ///< one is stopped in a debugger
};

/// @param with_memory  whether to read `memory`, which costs more than the rest.
Usage usage_of(const std::vector<pid_t>& processes, bool with_memory);

}  // namespace hc
