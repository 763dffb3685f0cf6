// SPDX-License-Identifier: Apache-2.0
#pragma once
// One wait for several descriptors, for programs that have no event loop.

#include <chrono>
#include <cstddef>
#include <span>

#include <hc/base/result.h>

namespace hc {

/// Waits until one of `descriptors` is readable; returns its index, or `descriptors.size()` when
/// `timeout` has passed.
///
/// Errors: Stopped (`stop` is readable), System.
Result<std::size_t> wait_readable(
    std::span<const int> descriptors, int stop = -1,
    std::chrono::milliseconds timeout = std::chrono::milliseconds(-1));

}  // namespace hc
