// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stands for what moves in demonstrations and tests: takes commands, and tells which it has taken.

/// The program, on a process's main thread or on one of a test.
int run_actor(int argc, char** argv);
