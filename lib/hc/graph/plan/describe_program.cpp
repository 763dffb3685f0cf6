// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>

#include <hc/graph/run.h>
#include <hc/graph/run/process.h>
#include <hc/link/link.h>

namespace hc {

using internal::Process;
using std::chrono::milliseconds;
using MonotonicClock = std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds kDescribeTime{10};
constexpr std::size_t kMaxDescription = std::size_t{1} << 20;

}  // namespace

Result<std::string> describe_program(const std::string& program, int stop) {
  auto process = Process::start({program, "--describe"}, Process::Capture::Output);
  if (!process) return process.error();
  std::string text;
  auto give_up = MonotonicClock::now() + kDescribeTime;
  auto wait = [&](int descriptor) -> Status {
    auto left = std::chrono::ceil<milliseconds>(give_up - MonotonicClock::now());
    std::array<int, 1> descriptors = {descriptor};
    auto ready = wait_readable(descriptors, stop, std::max(left, milliseconds(0)));
    if (!ready) return ready.error();
    if (*ready == 1) return Error{Code::System, program + " --describe does not end"};
    return {};
  };
  while (text.size() <= kMaxDescription) {
    if (auto ready = wait(process->output()); !ready) return ready.error();
    char piece[4096];
    ssize_t size = ::read(process->output(), piece, sizeof piece);
    if (size > 0) text.append(piece, static_cast<std::size_t>(size));
    if (size != 0) continue;
    if (auto ended = wait(process->ended()); !ended) return ended.error();
    int status = process->poll_status().value_or(0);
    if (status == 0) return text;
    return Error{Code::System,
                 program + " --describe failed with status " + std::to_string(status)};
  }
  return Error{Code::System, program + " --describe prints more than a MiB"};
}

std::string graph_token() {
  // Two graphs of one process may run side by side, and process numbers come back.
  return "hc-" + std::to_string(::getpid()) + "-" +
         std::to_string(MonotonicClock::now().time_since_epoch().count());
}

}  // namespace hc
