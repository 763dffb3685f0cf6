// SPDX-License-Identifier: Apache-2.0
#pragma once
// Starting threads.

#include <csignal>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <hc/base/result.h>

namespace hc {

/// Starts a thread with all signals blocked: signals are handled by the program's own threads.
///
/// Errors: System.
template <typename Work>
Result<std::thread> start_thread(Work work) {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  Result<std::thread> started = Error{};
  try {
    started = std::thread(std::move(work));
  } catch (const std::system_error& error) {
    started = Error{Code::System, std::string("thread: ") + error.what()};
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return started;
}

}  // namespace hc
