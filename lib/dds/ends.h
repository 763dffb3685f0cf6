// SPDX-License-Identifier: Apache-2.0
#pragma once
// Opens the ends of a DDS link. Internal.

#include <memory>

#include <hc/link/link.h>

namespace hc::dds {

/// Sends each message to all readers of the topic, at the pace of the slowest.
///
/// Errors: Invalid, System.
Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options);

/// Receives from all writers of the topic. A sample that is not a message is logged and dropped.
/// Ends `reconnect` seconds after all writers have closed or vanished.
///
/// Errors: Invalid, System.
Result<std::unique_ptr<Source>> open_source(const Uri& uri, const LinkOptions& options);

}  // namespace hc::dds
