// SPDX-License-Identifier: Apache-2.0
#pragma once
// Traces of modules in the format of Chrome's trace viewer. Pure.

#include <string>

#include "trace_paths.h"

namespace tool {

/// All events in Chrome's JSON trace format, which Perfetto opens: a process for each module, a
/// slice for each handler, an arrow for each message.
std::string to_chrome_trace(const Traced& traced);

}  // namespace tool
