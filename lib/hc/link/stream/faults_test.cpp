// SPDX-License-Identifier: Apache-2.0
// The conformance of stream links where system calls do the worst that they may: give and take a
// byte at a time, are interrupted, find nothing though poll said otherwise; and where sockets have
// the smallest buffers.
#undef _FORTIFY_SOURCE  // with it these calls are inline, and clang has them replaced by none
#include <dlfcn.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>

#include <hc/testing/socket_link.h>

namespace {

/// The kind of the next fault, from a fixed row of numbers that all threads share.
unsigned roll() {
  static std::atomic<std::uint64_t> state{1};
  std::uint64_t x = state.fetch_add(0x9E3779B97F4A7C15U);
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return static_cast<unsigned>(x >> 33);
}

/// Whether a call is to fail at once, with errno set.
bool fails(bool may_find_nothing) {
  unsigned kind = roll() % 8;
  if (kind == 0) errno = EINTR;
  if (kind == 1 && may_find_nothing) errno = EAGAIN;
  return kind == 0 || (kind == 1 && may_find_nothing);
}

/// How much of a size is let through: often a byte, sometimes a few, else all.
std::size_t some_of(std::size_t size) {
  unsigned kind = roll() % 8;
  if (kind < 3) return std::min<std::size_t>(size, 1);
  if (kind < 5) return std::min<std::size_t>(size, 1 + roll() % 100);
  return size;
}

template <typename Function>
Function* real(Function*, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// The first part of what is to be written; its size is changed.
iovec* shorten(iovec* first) {
  first->iov_len = some_of(first->iov_len);
  return first;
}

int with_small_buffers(int socket) {
  constexpr int kBytes = 4096;
  ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kBytes, sizeof kBytes);
  ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kBytes, sizeof kBytes);
  return socket;
}

}  // namespace

extern "C" {

ssize_t recv(int socket, void* bytes, size_t size, int flags) {
  static auto* next = real(&recv, "recv");
  return fails(true) ? -1 : next(socket, bytes, some_of(size), flags);
}

ssize_t read(int descriptor, void* bytes, size_t size) {
  static auto* next = real(&read, "read");
  return next(descriptor, bytes, size <= 8 ? size : some_of(size));  // an eventfd wants eight
}

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static auto* next = real(&sendmsg, "sendmsg");
  if (fails(true)) return -1;
  if (roll() % 2 == 0) return next(socket, message, flags);
  iovec part = message->msg_iov[0];
  msghdr shorter{};
  shorter.msg_iov = shorten(&part);
  shorter.msg_iovlen = 1;
  return next(socket, &shorter, flags);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static auto* next = real(&writev, "writev");
  if (fails(true)) return -1;
  if (roll() % 2 == 0) return next(descriptor, parts, count);
  iovec part = parts[0];
  return next(descriptor, shorten(&part), 1);
}

int poll(pollfd* polled, nfds_t count, int timeout) {
  static auto* next = real(&poll, "poll");
  return timeout != 0 && fails(false) ? -1 : next(polled, count, timeout);
}

int ppoll(pollfd* polled, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  static auto* next = real(&ppoll, "ppoll");
  return fails(false) ? -1 : next(polled, count, timeout, mask);
}

int epoll_wait(int descriptor, epoll_event* events, int most, int timeout) {
  static auto* next = real(&epoll_wait, "epoll_wait");
  return fails(false) ? -1 : next(descriptor, events, most, timeout);
}

int socket(int family, int type, int protocol) noexcept {
  static auto* next = real(&socket, "socket");
  return with_small_buffers(next(family, type, protocol));
}

int accept4(int listening, sockaddr* address, socklen_t* size, int flags) {
  static auto* next = real(&accept4, "accept4");
  return fails(false) ? -1 : with_small_buffers(next(listening, address, size, flags));
}

}  // extern "C"

namespace hc::testing {
namespace {

std::string abstract_name() {
  static int number = 0;
  return "@hc-faults-" + std::to_string(::getpid()) + "-" + std::to_string(number++);
}

std::pair<std::string, std::string> make_fifo() {
  auto path = std::filesystem::temp_directory_path() / abstract_name().substr(1);
  EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
  static std::vector<std::string> made;
  made.push_back(path);
  std::atexit([] {
    for (const auto& each : made) std::filesystem::remove(each);
    made.clear();
  });
  return {"file:" + path.string(), "file:" + path.string()};
}

const SocketScheme kUnix{"unix", abstract_name, "unix:", "unix-listen:", {}};
const SocketScheme kTcp{"tcp", free_port, "tcp:", "tcp-listen:", {}};

INSTANTIATE_TEST_SUITE_P(Unix, LinkConformance, ::testing::ValuesIn(both_ways(kUnix)));
INSTANTIATE_TEST_SUITE_P(Tcp, LinkConformance, ::testing::ValuesIn(both_ways(kTcp)));
INSTANTIATE_TEST_SUITE_P(Fifo, LinkConformance,
                         ::testing::Values(Transport{"fifo", make_fifo, false, true}));

}  // namespace
}  // namespace hc::testing
