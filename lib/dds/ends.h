// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two ends of a link by DDS. Internal.

#include <memory>

#include <hc/link/link.h>

namespace hc::dds {

/// Puts each message to all readers of the topic, at the pace of the slowest.
///
/// Errors: Invalid, NotFound (no such interface), System.
Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options);

/// Takes what any writer of the topic sends. A sample that is no message is logged and dropped.
/// It ends when all writers that it had have closed or vanished, or with `reconnect` so many
/// seconds later.
///
/// Errors: Invalid, NotFound (no such interface), System.
Result<std::unique_ptr<Source>> open_source(const Uri& uri, const LinkOptions& options);

}  // namespace hc::dds
