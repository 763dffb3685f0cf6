// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads in the place of a module that has ended, so that no writer waits for it. Internal to graph.

#include <memory>
#include <string>

#include <hc/link/intake.h>

namespace hc::internal {

/// Drops all messages of a link.
///
/// @param reader_uri  of the module's end; its `wait` is ignored, and it keeps no message from
/// being
///     overwritten.
///
/// Errors: as Intake::make.
Result<std::unique_ptr<Intake>> make_drain(Loop& loop, const std::string& reader_uri);

}  // namespace hc::internal
