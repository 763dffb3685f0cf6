// SPDX-License-Identifier: Apache-2.0
#pragma once
// Limits the pace of a link at its reader, for writers that cannot because they write into memory
// shared by all readers. Internal.

#include <memory>

#include <hc/link/link.h>
#include <hc/link/policy.h>

namespace hc::internal {

/// A source that passes the messages of `source` on at the pace of `policy`. Messages overtaken
/// meanwhile count as Traffic::throttled, delayed ones as Traffic::delayed.
///
/// @returns  `source` itself if it is not limited. Errors: System.
Result<std::unique_ptr<Source>> make_paced(std::unique_ptr<Source> source, const Policy& policy);

}  // namespace hc::internal
