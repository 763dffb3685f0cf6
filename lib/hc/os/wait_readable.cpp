// SPDX-License-Identifier: Apache-2.0
#include <hc/os/wait_readable.h>

#include <algorithm>
#include <vector>

#include <hc/os/descriptor.h>

namespace hc {

Result<std::size_t> wait_readable(std::span<const int> descriptors, int stop,
                                  std::chrono::milliseconds timeout) {
  std::vector<pollfd> polled;
  for (int descriptor : descriptors) polled.push_back({descriptor, POLLIN, 0});
  polled.push_back({stop, POLLIN, 0});
  HC_TRY(
      poll_until(polled, timeout.count() < 0 ? Deadline::max() : Deadline::clock::now() + timeout));
  if (polled.back().revents != 0) return Error{Code::Stopped, "asked to stop"};
  auto first = std::find_if(polled.begin(), polled.end() - 1,
                            [](const pollfd& entry) { return entry.revents != 0; });
  return static_cast<std::size_t>(first - polled.begin());
}

}  // namespace hc
