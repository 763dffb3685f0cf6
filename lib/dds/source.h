// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages out of a topic of DDS. Internal.

#include <memory>

#include <dds/place.h>
#include <hc/link/link.h>

namespace hc::dds {

/// Takes what any writer of the topic sends. A sample that is no message is logged and dropped.
/// It ends when all writers that it had have closed or vanished, or with `reconnect` so many
/// seconds later.
///
/// @param uri  for its options.
/// Errors: Invalid, NotFound (no such interface), System.
Result<std::unique_ptr<Source>> make_source(const Place& place, const Uri& uri,
                                            const LinkOptions& options);

}  // namespace hc::dds
