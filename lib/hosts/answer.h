// SPDX-License-Identifier: Apache-2.0
#pragma once
// Asks a loop's thread from another thread, and waits for the answer. Internal.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <hc/os/loop.h>

namespace hc::hosts {

template <typename T>
using Give = std::function<void(Result<T>)>;

/// Calls `begin` on the loop's thread and blocks the calling thread until the answer is given.
///
/// Errors: Stopped (`stop` is readable), Closed (timeout), System.
template <typename T>
Result<T> answer_of(Loop& loop, int stop, std::chrono::nanoseconds timeout,
                    std::function<void(Give<T>)> begin) {
  struct Here {
    std::unique_ptr<Loop> loop;
    std::optional<Result<T>> answer;
  };
  auto here = std::make_shared<Here>(Here{HC_TRY(Loop::make()), {}});
  loop.post([here, begin = std::move(begin)] {
    begin([here](Result<T> value) {
      here->loop->post(
          [self = here.get(), value = std::move(value)] { self->answer.emplace(value); });
    });
  });
  const auto stopped = HC_TRY(here->loop->watch(stop, stop < 0 ? 0U : EPOLLIN, [&](auto) {
    here->answer.emplace(Error{Code::Stopped, "asked to stop"});
  }));
  const auto late = here->loop->call_at(std::chrono::steady_clock::now() + timeout, [&] {
    if (!here->answer) here->answer.emplace(Error{Code::Closed, "timed out"});
  });
  while (!here->answer) HC_TRY(here->loop->turn());
  return std::move(*here->answer);
}

}  // namespace hc::hosts
