// SPDX-License-Identifier: Apache-2.0
#pragma once
// An actuator for tests: takes commands and reports which.

/// The program, on a process's main thread or on one of a test.
int run_actor(int argc, char** argv);
