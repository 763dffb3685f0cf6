// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs work that may hang on a thread that can be abandoned.

#include <memory>
#include <optional>
#include <utility>

#include <hc/os/event.h>
#include <hc/os/thread.h>

namespace hc {

/// Work that may block indefinitely in a system call, such as stat() on a network disk that hangs.
/// It runs on a thread, which is abandoned when this is destroyed; it must therefore own everything
/// that it uses.
template <typename Value>
class Detached {
 public:
  /// Errors: System (no descriptor or thread available).
  template <typename Work>
  static Result<Detached> begin(Work work) {
    Detached made;
    made.shared_->done = HC_TRY(Event::make());
    auto thread = HC_TRY(start_thread([shared = made.shared_, work = std::move(work)]() mutable {
      shared->value.emplace(work());
      shared->done.raise();
    }));
    thread.detach();
    return made;
  }

  /// Readable when the work is done.
  [[nodiscard]] int descriptor() const { return shared_->done.descriptor(); }
  /// What the work has returned; none before it is done, and the second time.
  std::optional<Value> take() {
    return shared_->done.clear() ? std::optional(std::move(*shared_->value)) : std::nullopt;
  }

 private:
  struct Shared {
    Event done;
    std::optional<Value> value;
  };

  Detached() = default;

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

}  // namespace hc
