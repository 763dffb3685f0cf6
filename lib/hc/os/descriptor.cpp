// SPDX-License-Identifier: Apache-2.0
#include <hc/os/descriptor.h>

#include <algorithm>
#include <array>

namespace hc::internal {

Result<bool> wait_for(int descriptor, short events, int stop, Deadline deadline) {
  using std::chrono::nanoseconds;
  std::array<pollfd, 2> polled = {{{descriptor, events, 0}, {stop, POLLIN, 0}}};
  auto ready = HC_TRY(system_call("ppoll", "", [&] {
    timespec left{};
    if (deadline != Deadline::max()) {
      auto time =
          std::max<nanoseconds>(nanoseconds(0), deadline - std::chrono::steady_clock::now());
      left = {time.count() / std::nano::den, time.count() % std::nano::den};
    }
    return ::ppoll(polled.data(), polled.size(), deadline == Deadline::max() ? nullptr : &left,
                   nullptr);
  }));
  if (polled[0].revents == 0 && polled[1].revents != 0)
    return Error{Code::Stopped, "asked to stop"};
  return ready > 0;
}

}  // namespace hc::internal
