// SPDX-License-Identifier: Apache-2.0
#pragma once
// The global workspace's judge: tasks bid, one mode gets the focus, all are told.

#include <hc/base/clock.h>

/// The program, on a process's main thread or on one of a test.
/// @param clock  by which bids stand and decisions are due.
int run_workspace(int argc, char** argv, const hc::Clock& clock);
