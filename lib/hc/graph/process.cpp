// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/process.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <array>
#include <csignal>

namespace hc::internal {
namespace {

constexpr int kCannotExecute = 127;

/// In the child, between fork and exec: nothing here may allocate.
[[noreturn]] void become(char* const* arguments, int output, Process::Capture capture, int errors,
                         pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotExecute);  // it died before it could be noticed
  int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(null, STDIN_FILENO);
  ::dup2(capture == Process::Capture::Output ? output : null, STDOUT_FILENO);
  ::dup2(capture == Process::Capture::Errors ? output : null, STDERR_FILENO);
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  ::execvp(arguments[0], arguments);
  int number = errno;
  [[maybe_unused]] auto written = ::write(errors, &number, sizeof number);
  ::_exit(kCannotExecute);
}

Result<std::array<Descriptor, 2>> make_pipe() {
  int ends[2];
  auto made = system_call("pipe2", "", [&] { return ::pipe2(ends, O_CLOEXEC); });
  if (!made) return made.error();
  return std::array<Descriptor, 2>{Descriptor(ends[0]), Descriptor(ends[1])};
}

}  // namespace

Result<Process> Process::start(const std::vector<std::string>& command, Capture capture) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  auto output = make_pipe();
  if (!output) return output.error();
  auto errors = make_pipe();
  if (!errors) return errors.error();

  pid_t parent = ::getpid();
  pid_t child = ::fork();
  if (child < 0) return system_error("fork", command[0]);
  if (child == 0) become(arguments.data(), (*output)[1].get(), capture, (*errors)[1].get(), parent);
  ::setpgid(child, child);

  Process process;
  process.number_ = child;
  process.handle_ = Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, child, 0)));
  process.output_ = std::move((*output)[0]);
  ::fcntl(process.output_.get(), F_SETFL, O_NONBLOCK);
  // The pipe closes by itself when exec succeeds.
  (*errors)[1].reset();
  int number = 0;
  auto size =
      system_call("read", "", [&] { return ::read((*errors)[0].get(), &number, sizeof number); });
  if (size && *size == sizeof number) return system_error("exec", command[0], number);
  if (!process.handle_) return system_error("pidfd_open", command[0]);
  return process;
}

Process::~Process() {
  if (!owned_.flag || number_ < 0) return;
  signal(SIGKILL);
  if (!status_) ::waitpid(number_, nullptr, 0);
}

std::optional<int> Process::poll_status() {
  int status = 0;
  if (status_ || ::waitpid(number_, &status, WNOHANG) != number_) return status_;
  status_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return status_;
}

void Process::signal(int number) const {
  ::kill(-number_, number);
}

}  // namespace hc::internal
