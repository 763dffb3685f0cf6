// SPDX-License-Identifier: Apache-2.0
#include <hc/os/program.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <system_error>

namespace hc {
namespace {

int stop_event = -1;  // written by the signal handler
volatile std::sig_atomic_t stop_asked = 0;
std::array<std::atomic<std::int64_t>, SIGTERM + 1> first_signal{};  // by number [ns]

extern "C" void ask_to_stop(int number) {
  // Signals within this time count as one: `timeout` sends two. [ns]
  constexpr std::int64_t kSame = 1'000'000'000;
  int saved = errno;
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  const std::int64_t now = time.tv_sec * 1'000'000'000 + time.tv_nsec;
  std::int64_t first = 0;
  auto& known = first_signal.at(static_cast<std::size_t>(number));
  if (!known.compare_exchange_strong(first, now) && now - first > kSame) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  stop_asked = 1;
  std::uint64_t one = 1;
  [[maybe_unused]] auto written = ::write(stop_event, &one, sizeof one);
  errno = saved;
}

int catch_signals() {
  stop_event = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  struct sigaction inherited {};
  ::sigaction(SIGHUP, nullptr, &inherited);
  if (inherited.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return stop_event;
}

}  // namespace

void prepare_program() {
  std::signal(SIGXFSZ, SIG_IGN);
  int opened = ::open("/dev/null", O_RDWR);
  while (opened >= 0 && opened <= STDERR_FILENO) opened = ::open("/dev/null", O_RDWR);
  if (opened >= 0) ::close(opened);
}

int stop_descriptor() {
  static const int kDescriptor = catch_signals();
  return kDescriptor;
}

bool stop_requested() {
  return stop_asked != 0;
}

Status write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    ssize_t size = ::write(descriptor, text.data(), text.size());
    if (size >= 0) {
      text.remove_prefix(static_cast<std::size_t>(size));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      pollfd writable{descriptor, POLLOUT, 0};
      ::poll(&writable, 1, -1);
    } else if (errno == EPIPE) {
      return Error{Code::Closed, "the reader has closed it"};
    } else if (errno != EINTR) {
      return Error{Code::System, "write: " + std::generic_category().message(errno)};
    }
  }
  return {};
}

}  // namespace hc
