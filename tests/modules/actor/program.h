// SPDX-License-Identifier: Apache-2.0
#pragma once
// An actuator for tests: takes commands and reports which.

#include <hc/base/clock.h>

/// The program, on a process's main thread or on one of a test.
/// @param clock  by which the focus expires.
int run_actor(int argc, char** argv, const hc::Clock& clock);
