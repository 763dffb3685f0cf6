// SPDX-License-Identifier: Apache-2.0
#pragma once
// Process set-up shared by all programs: standard descriptors, signals that stop them, and writing
// of text that a person asked for.

#include <string_view>

#include <hc/base/result.h>

namespace hc {

/// Opens /dev/null for closed descriptors among 0 to 2; otherwise the next file opened would
/// receive standard output or error. Ignores SIGXFSZ, so that a write beyond the limit of a file
/// fails instead of killing the program. Call it first in main().
void prepare_program();

/// A descriptor that becomes readable on SIGINT, SIGTERM or SIGHUP (unless that is ignored, as
/// under nohup); they are caught from the first call on. Repeating a signal kills as usual, except
/// within 1 s. SIGPIPE is ignored. Always returns the same descriptor, on any thread.
int stop_descriptor();

/// Whether such a signal was received. For loops that never wait.
bool stop_requested();

/// Writes a whole text, waiting where the descriptor would block.
///
/// Errors: Closed (the reader has closed the descriptor), System.
Status write_all(int descriptor, std::string_view text);

}  // namespace hc
