// SPDX-License-Identifier: Apache-2.0
#include <hc/os/first_process.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace hc {
namespace {

/// Serves a process, with all signals blocked, until it has ended.
[[noreturn]] void serve(pid_t served, const sigset_t& all) {
  while (true) {
    siginfo_t got{};
    const int number = ::sigwaitinfo(&all, &got);
    // The terminal's signals reach the whole group.
    const bool is_for_us_alone = number > 0 && got.si_code <= 0;
    if (is_for_us_alone && number != SIGCHLD) ::kill(served, number);
    int status = 0;
    for (pid_t ended = 0; (ended = ::waitpid(-1, &status, WNOHANG)) > 0;)
      if (ended == served)
        ::_exit(WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status));
  }
}

}  // namespace

void leave_first_process() {
  if (::getpid() != 1) return;
  sigset_t all, before;
  ::sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, &before);
  std::signal(SIGCHLD, SIG_DFL);  // if ignored, there would be no status
  if (const pid_t child = ::fork(); child > 0) serve(child, all);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);  // also where it cannot fork
}

}  // namespace hc
