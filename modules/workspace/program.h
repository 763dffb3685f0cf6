// SPDX-License-Identifier: Apache-2.0
#pragma once
// Arbitrates between tasks: grants the focus to the highest bid and publishes it.

#include <hc/base/clock.h>

/// Runs the program, on a main thread or a test's.
/// @param clock  for the expiry of bids and the period of decisions.
int run_workspace(int argc, char** argv, const hc::Clock& clock);
