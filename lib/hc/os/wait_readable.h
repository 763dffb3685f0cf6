// SPDX-License-Identifier: Apache-2.0
#pragma once
// Waits for several descriptors, for programs without an event loop.

#include <chrono>
#include <cstddef>
#include <span>

#include <hc/base/result.h>

namespace hc {

/// Waits until one of `descriptors` is readable; returns its index, or `descriptors.size()` after
/// `timeout`.
///
/// Errors: Stopped (`stop` is readable), System.
Result<std::size_t> wait_readable(
    std::span<const int> descriptors, int stop = -1,
    std::chrono::milliseconds timeout = std::chrono::milliseconds(-1));

}  // namespace hc
