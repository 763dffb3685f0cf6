// SPDX-License-Identifier: Apache-2.0
#pragma once
// Exceptions that end a module. Internal.

#include <exception>
#include <string>

#include <hc/module/module.h>

namespace hc::internal {

/// Thrown to end a module cleanly: its last reader has left, or it was asked to stop.
struct Stopped {};

/// Ends the module: cleanly if it was asked to stop, else with an error.
[[noreturn]] inline void fail(const Error& error) {
  if (error.code == Code::Stopped) throw Stopped();
  throw ModuleError(error);
}
/// The same with the name of the part that failed.
[[noreturn]] inline void fail(const std::string& part, const Error& error) {
  fail(Error{error.code, part + ": " + error.detail});
}

/// The text of an exception, without the position in the sources of a library.
std::string thrown_in_words(const std::exception& error);

}  // namespace hc::internal
