// SPDX-License-Identifier: Apache-2.0
#pragma once
// Arbitrates between tasks: grants the focus to the highest bid and publishes it.

#include <hc/base/clock.h>

/// The program, on a process's main thread or on one of a test.
/// @param clock  by which bids expire and decisions are due.
int run_workspace(int argc, char** argv, const hc::Clock& clock);
