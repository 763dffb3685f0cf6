// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the processes of the shm tests do. Both end well (0) when the test closes their socket, and
// with 3 and a line on standard error when something is not as it should be.
//
//   PROGRAM publisher URI ID COUNT BYTES
//     sends COUNT (0: without end) checked messages of BYTES or of `mixed` sizes, every second one
//     in memory of the link; says at its end: sent COUNT
//   PROGRAM reader URI gapless|newest HOLD
//     takes messages, checks each at once and once more when it lets it go; holds up to HOLD. When
//     its publisher ends it says: end RECEIVED SUPERSEDED LAST, and opens the link again. Asked
//     `after PLACE`, it answers with the first message behind that place: PLACE TIME [ns].
//   PROGRAM holder URI HOLD
//     takes HOLD messages, says: holds PLACE, and keeps them.

#include <span>
#include <string>

namespace hc::testing {

/// The exit status of a role; -1: these are arguments for something else.
int run_role(std::span<char* const> arguments);

}  // namespace hc::testing
