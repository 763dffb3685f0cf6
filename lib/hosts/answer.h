// SPDX-License-Identifier: Apache-2.0
#pragma once
// Asks the thread of a loop, from another thread, and waits for the answer. Internal.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <hc/os/loop.h>

namespace hc::hosts {

template <typename T>
using Give = std::function<void(Result<T>)>;

/// Calls `begin` on the loop's thread and waits, on this other thread, until it has given an
/// answer.
///
/// Errors: Stopped (`stop` is readable), Closed (no answer in time), System.
template <typename T>
Result<T> answer_of(internal::Loop& loop, int stop, std::chrono::nanoseconds timeout,
                    std::function<void(Give<T>)> begin) {
  struct Here {
    std::unique_ptr<internal::Loop> loop;
    std::optional<Result<T>> answer;
  };
  auto made = internal::Loop::make();
  if (!made) return made.error();
  auto here = std::make_shared<Here>(Here{std::move(*made), {}});
  loop.post([here, begin = std::move(begin)] {
    begin([here](Result<T> value) {
      here->loop->post(
          [self = here.get(), value = std::move(value)] { self->answer.emplace(value); });
    });
  });
  internal::Loop::Handle stopped;
  if (stop >= 0) {
    auto watched = here->loop->watch(stop, EPOLLIN, [&](auto) {
      here->answer.emplace(Error{Code::Stopped, "asked to stop"});
    });
    if (!watched) return watched.error();
    stopped = std::move(*watched);
  }
  const auto late = here->loop->call_at(std::chrono::steady_clock::now() + timeout, [&] {
    if (!here->answer) here->answer.emplace(Error{Code::Closed, "no answer in time"});
  });
  while (!here->answer)
    if (auto turned = here->loop->turn(); !turned) return turned.error();
  return std::move(*here->answer);
}

}  // namespace hc::hosts
