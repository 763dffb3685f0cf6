// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages into a topic of DDS. Internal.

#include <memory>

#include <dds/place.h>
#include <hc/link/link.h>

namespace hc::dds {

/// Puts each message to all readers of the topic, at the pace of the slowest.
///
/// @param uri  for its options.
/// Errors: Invalid, NotFound (no such interface), System.
Result<std::unique_ptr<Sink>> make_sink(const Place& place, const Uri& uri,
                                        const LinkOptions& options);

}  // namespace hc::dds
