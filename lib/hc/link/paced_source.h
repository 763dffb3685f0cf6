// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rate of a link whose writer does not keep it, since it writes into memory for all readers at
// once. Internal.

#include <memory>

#include <hc/link/link.h>
#include <hc/link/policy.h>

namespace hc::internal {

/// A source that gives what `source` gives, at the rate of `policy`. What is overtaken meanwhile is
/// counted as Traffic::throttled, what is delayed as Traffic::delayed.
///
/// @returns  `source` itself where there is no rate. Errors: System.
Result<std::unique_ptr<Source>> make_paced(std::unique_ptr<Source> source, const Policy& policy);

}  // namespace hc::internal
