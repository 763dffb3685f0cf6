// SPDX-License-Identifier: Apache-2.0
#include <graph/process.h>

#include <dirent.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <array>
#include <charconv>
#include <csignal>
#include <cstring>
#include <string_view>

#include <graph/plan.h>
#include <hc/base/format.h>
#include <hc/link/stream/ends.h>

namespace hc {

namespace {

/// The arguments of a guard and its program. Between fork and exec, and in a guard at any time,
/// nothing may allocate: another thread may have held a lock at the fork.
struct Start {
  char* const* arguments;
  int input, output, errors;  // of the program; -1: none
  int number;                 // to write the program's PID, or -errno if it was not started
  int life;                   // at its end when the parent has ended
  const Inherited* inherited;
  char* const* environment;
};

/// Ends a guard without a program; the parent gets errno.
[[noreturn]] void give_up(const Start& start) {
  const int why = -errno;
  [[maybe_unused]] const auto written = ::write(start.number, &why, sizeof why);
  ::_exit(kCannotExecute);
}

/// Closes what exec would close: a hanging disk may delay exec for ever, while others, such as
/// guards, wait for the ends of these pipes.
void close_on_exec(const Start& start) {
  const int list = ::open("/proc/self/fd", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (list < 0) give_up(start);
  alignas(dirent64) char piece[4096];
  for (ssize_t size = 0; (size = ::getdents64(list, piece, sizeof piece)) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const dirent64*>(piece + at);
      at += entry->d_reclen;
      int number = -1;
      std::from_chars(entry->d_name, entry->d_name + std::strlen(entry->d_name), number);
      if (number >= 0 && number != list && number != start.life && number != start.number &&
          (::fcntl(number, F_GETFD) & FD_CLOEXEC) != 0)
        ::close(number);
    }
  ::close(list);
}

/// Executes the program, or writes to standard error why it cannot.
[[noreturn]] void become(const Start& start, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotExecute);  // the guard died before prctl
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execvpe(start.arguments[0], start.arguments, start.environment);
  const char* const why = ::strerrordesc_np(errno);
  for (const char* part : std::array<const char*, 5>{"exec(", start.arguments[0], "): ", why, "\n"})
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  ::_exit(kCannotExecute);
}

/// Sends SIGKILL to all children; returns whether one could be signalled.
bool kill_children() {
  int list = ::open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
  bool any = false;
  pid_t child = 0;
  char piece[4096];
  for (ssize_t size = 0; (size = ::read(list, piece, sizeof piece)) > 0;)
    for (ssize_t i = 0; i < size; ++i) {
      if (piece[i] >= '0' && piece[i] <= '9') {
        child = child * 10 + (piece[i] - '0');
      } else if (child != 0) {
        any = ::kill(child, SIGKILL) == 0 || any;
        child = 0;
      }
    }
  ::close(list);
  return any;
}

/// The guard of a program: see process.h.
[[noreturn]] void guard(Start start) {
  sigset_t all, ended;
  ::sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, nullptr);
  std::signal(SIGCHLD, SIG_DFL);  // if ignored, waitpid would not work
  ::setpgid(0, 0);
  ::prctl(PR_SET_NAME, "guard");
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  pid_t self = ::getpid();
  // Before the fork, since anyone may stop the program before it would do this itself.
  for (int* kept : {&start.life, &start.number}) {
    const int copy = ::fcntl(*kept, F_DUPFD_CLOEXEC, kKeyDescriptor + 1);
    if (copy < 0) give_up(start);
    *kept = copy;
  }
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (null < 0) give_up(start);
  ::dup2(start.input >= 0 ? start.input : null, STDIN_FILENO);
  ::dup2(start.output >= 0 ? start.output : null, STDOUT_FILENO);
  ::dup2(start.errors >= 0 ? start.errors : null, STDERR_FILENO);
  for (const int listener : start.inherited->listeners) ::fcntl(listener, F_SETFD, 0);
  if (const int key = start.inherited->key; key == kKeyDescriptor)
    ::fcntl(key, F_SETFD, 0);
  else if (key >= 0)
    ::dup2(key, kKeyDescriptor);
  close_on_exec(start);
  const pid_t program = ::fork();
  if (program == 0) become(start, self);
  if (program < 0) give_up(start);
  // Fails if the parent has ended meanwhile; then the program is killed below.
  [[maybe_unused]] const auto written = ::write(start.number, &program, sizeof program);

  // The fork has also inherited the pipes of other processes and would keep them open.
  ::dup2(start.life, 0);
  ::close_range(1, ~0U, 0);
  ::sigemptyset(&ended);
  ::sigaddset(&ended, SIGCHLD);
  pollfd polled[] = {{0, POLLIN, 0}, {::signalfd(-1, &ended, SFD_NONBLOCK), POLLIN, 0}};
  int status = 0;
  bool has_ended = false;
  while (!has_ended && polled[0].revents == 0) {
    ::poll(polled, 2, -1);
    signalfd_siginfo signal;
    while (::read(polled[1].fd, &signal, sizeof signal) > 0) {
    }
    int each = 0;
    for (pid_t child = 0; (child = ::waitpid(-1, &each, WNOHANG)) > 0;) {
      if (child != program) continue;
      has_ended = true;
      status = WIFSIGNALED(each) ? 128 + WTERMSIG(each) : WEXITSTATUS(each);
    }
  }
  // Orphans become our children, so this continues until no process is left.
  while (kill_children()) ::waitpid(-1, nullptr, 0);
  // If the system lists no children: kill the group, including this process.
  if (!has_ended) ::kill(0, SIGKILL);
  ::_exit(status);
}

/// Pointers to words, null-terminated, for exec.
std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> made;
  made.reserve(words.size() + 1);
  for (const auto& word : words) made.push_back(const_cast<char*>(word.c_str()));
  made.push_back(nullptr);
  return made;
}

/// The environment, with these listeners instead of inherited ones.
std::vector<std::string> environment_with(const std::vector<int>& listeners) {
  const std::string prefix = std::string(internal::kListeners) + "=";
  std::vector<std::string> words;
  for (char** word = environ; *word != nullptr; ++word)
    if (!std::string_view(*word).starts_with(prefix)) words.emplace_back(*word);
  if (!listeners.empty()) words.push_back(prefix + joined(listeners, " "));
  return words;
}

Error start_error(const std::string& program, int number) {
  const std::string why = number == EAGAIN
                              ? "limit of processes of this user or control group reached (ulimit "
                                "-u, pids.max)"
                              : std::strerror(number);
  return {Code::System, program + " cannot be started: " + why};
}

Result<std::array<Descriptor, 2>> make_pipe() {
  int ends[2];
  HC_TRY(system_call("pipe2", "", [&] { return ::pipe2(ends, O_CLOEXEC); }));
  return std::array<Descriptor, 2>{Descriptor(ends[0]), Descriptor(ends[1])};
}

}  // namespace

Result<Process> Process::start(const std::vector<std::string>& command, Capture capture,
                               const Inherited& inherited) {
  const auto words = environment_with(inherited.listeners);
  const auto arguments = pointers(command), environment = pointers(words);
  auto output = HC_TRY(make_pipe());
  auto number = HC_TRY(make_pipe());
  auto life = HC_TRY(make_pipe());
  std::array<Descriptor, 2> input, errors;
  if (capture == Capture::Both)
    for (auto* ends : {&input, &errors}) *ends = HC_TRY(make_pipe());

  const int captured = output[1].get();
  const bool is_both = capture == Capture::Both;
  const Start start{arguments.data(),
                    input[0].get(),
                    capture == Capture::Errors ? -1 : captured,
                    is_both                      ? errors[1].get()
                    : capture == Capture::Errors ? captured
                                                 : -1,
                    number[1].get(),
                    life[0].get(),
                    &inherited,
                    environment.data()};
  const pid_t child = ::fork();
  if (child < 0) return start_error(command[0], errno);
  if (child == 0) guard(start);

  Process process;
  process.guard_ = child;
  process.handle_ = Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, child, 0)));
  process.output_ = std::move(output[0]);
  process.errors_ = std::move(errors[0]);
  process.input_ = std::move(input[1]);
  process.life_ = std::move(life[1]);
  for (const auto* ours : {&process.output_, &process.errors_, &process.input_})
    if (*ours) ::fcntl(ours->get(), F_SETFL, O_NONBLOCK);
  if (!process.handle_) return system_error("pidfd_open", command[0]);
  number[1].reset();
  int& started = process.number_;  // 0: the guard was killed; poll_status() will report it
  HC_TRY(
      system_call("read", "", [&] { return ::read(number[0].get(), &started, sizeof started); }));
  if (started < 0) return start_error(command[0], -started);
  return process;
}

Process::~Process() {
  if (!owned_.flag || guard_ < 0 || status_) return;
  kill();
  siginfo_t ended{};
  while (::waitid(P_PID, static_cast<id_t>(guard_), &ended, WEXITED | WNOWAIT) < 0 &&
         errno == EINTR) {
  }
  poll_status();
}

std::optional<int> Process::poll_status() {
  siginfo_t ended{};
  if (status_ || ::waitid(P_PID, static_cast<id_t>(guard_), &ended, WEXITED | WNOHANG | WNOWAIT) ||
      ended.si_pid != guard_)
    return status_;
  // A killed guard could not do this. Its PID is not reused until it is reaped.
  ::kill(-guard_, SIGKILL);
  int status = 0;
  ::waitpid(guard_, &status, 0);
  status_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return status_;
}

void Process::ask_to_end() const {
  if (status_) return;
  // SIGCONT first: later it could resume a process that a leak checker or debugger has stopped at
  // its end.
  ::kill(-guard_, SIGCONT);
  ::kill(-guard_, SIGTERM);
}

}  // namespace hc
