// SPDX-License-Identifier: Apache-2.0
#pragma once
// The pace of a policy (`rate`) before a sink that has none itself. Internal.

#include <memory>

#include <hc/link/link.h>
#include <hc/link/policy.h>
#include <hc/link/stream/remarks.h>

namespace hc::internal {

/// A sink before `sink` that lets messages pass at the pace of `policy`, on the caller's thread
/// when they are in time, else on the thread that serves links. Where the writer waits, it waits
/// for its turn here; else `keep` messages wait, and the oldest make room.
///
/// @param sink  does not wait itself, but for its first readers, unless the writer is to wait.
/// @param remarks  of `sink`, which are told the log on the caller's thread.
/// @returns  `sink` itself where the policy has no pace. Errors: System.
Result<std::unique_ptr<Sink>> make_paced(std::unique_ptr<Sink> sink, const Policy& policy,
                                         const LinkOptions& options,
                                         std::shared_ptr<Remarks> remarks);

}  // namespace hc::internal
