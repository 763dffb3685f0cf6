// SPDX-License-Identifier: Apache-2.0
#pragma once
// What every program of ours needs from the system: standard descriptors, the signals that end it,
// and text that a person asked for. The library itself never writes anything on its own account.

#include <string_view>

#include <hc/base/result.h>

namespace hc {

/// Opens /dev/null for those of the descriptors 0 to 2 that are closed: else the first file that is
/// opened would get what is written to standard output or error. Called first thing in a program.
void open_standard_descriptors();

/// A descriptor that is readable once SIGINT, SIGTERM or, unless it is ignored as under nohup,
/// SIGHUP has come, caught from the first call on; another one kills, as usual, unless it follows
/// at once.
/// SIGPIPE and SIGXFSZ are ignored from then on. Always the same descriptor. For the main thread.
int stop_descriptor();

/// Whether such a signal has come since. For loops that may never wait.
bool stop_requested();

/// Writes all of a text, waiting where the descriptor would block.
///
/// Errors: Closed (nobody reads it any more), System.
Status write_all(int descriptor, std::string_view text);

}  // namespace hc
