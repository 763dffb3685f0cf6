// SPDX-License-Identifier: Apache-2.0
#pragma once
// File descriptors that close themselves, and system calls whose errors name the call.

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <hc/base/result.h>

namespace hc {

/// Owns a file descriptor, or none (-1).
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { reset(); }

  [[nodiscard]] int get() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  void reset() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_ = -1;
};

/// "open(eyes.mtp): No such file or directory", from errno.
inline Error system_error(std::string_view call, std::string_view argument, int number = errno) {
  bool closed = number == EPIPE || number == ECONNRESET || number == ECONNREFUSED ||
                number == ETIMEDOUT;  // a peer that vanished
  Code code = number == ENOENT ? Code::NotFound : closed ? Code::Closed : Code::System;
  std::string detail(call);
  detail.append("(").append(argument).append("): ").append(std::strerror(number));
  return {code, std::move(detail)};
}

/// Makes a system call that returns -1 on failure, and repeats it while signals interrupt it.
template <typename Call>
Result<std::invoke_result_t<Call>> system_call(std::string_view name, std::string_view argument,
                                               Call&& call) {
  while (true) {
    auto value = call();
    if (value != -1) return value;
    if (errno != EINTR) return system_error(name, argument);
  }
}

/// A system_call() that opens a descriptor.
template <typename Call>
Result<Descriptor> open_descriptor(std::string_view name, std::string_view argument, Call&& call) {
  auto number = HC_TRY(system_call(name, argument, std::forward<Call>(call)));
  return Descriptor(number);
}

using Deadline = std::chrono::steady_clock::time_point;

/// poll() until `deadline`, or without a limit (Deadline::max()); the number of ready descriptors.
/// Errors: System.
Result<int> poll_until(std::span<pollfd> polled, Deadline deadline);

/// Waits until `descriptor` has one of the poll events; false if `deadline` passes first.
///
/// Errors: Stopped when `stop` is readable and the descriptor has none of the events; System.
Result<bool> wait_for(int descriptor, short events, int stop, Deadline deadline = Deadline::max());

}  // namespace hc
