// SPDX-License-Identifier: Apache-2.0
#include <hc/os/descriptor.h>

#include <algorithm>
#include <array>

namespace hc {

Result<int> poll_until(std::span<pollfd> polled, Deadline deadline) {
  using std::chrono::nanoseconds;
  return system_call("ppoll", "", [&] {
    const bool is_limited = deadline != Deadline::max();
    nanoseconds left(0);
    if (is_limited) left = std::max(left, nanoseconds(deadline - Deadline::clock::now()));
    const timespec time{left.count() / std::nano::den, left.count() % std::nano::den};
    return ::ppoll(polled.data(), polled.size(), is_limited ? &time : nullptr, nullptr);
  });
}

Result<bool> wait_for(int descriptor, short events, int stop, Deadline deadline) {
  std::array<pollfd, 2> polled = {{{descriptor, events, 0}, {stop, POLLIN, 0}}};
  const int ready = HC_TRY(poll_until(polled, deadline));
  if (polled[0].revents == 0 && polled[1].revents != 0)
    return Error{Code::Stopped, "asked to stop"};
  return ready > 0;
}

}  // namespace hc
