// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which readers a sink waits for: the options `readers`, `stay`, `wait` and `timeout`, for all
// transports alike. Internal. Used on the sending thread.

#include <cstdint>
#include <functional>

#include <hc/link/link.h>
#include <hc/link/policy.h>

namespace hc::internal {

/// Waits until `descriptor` is readable or `until` has passed. Also returns after a call of
/// LinkOptions::interrupt, which it makes when that is due.
///
/// Errors: Stopped, System.
Status wait_for_event(int descriptor, LinkOptions& options, TimePoint until = TimePoint::max());

class Audience {
 public:
  /// @param most  maximum of `readers`. @param policy  of the same URI. Errors: Invalid.
  static Result<Audience> make(const Uri& uri, std::int64_t most, const Policy& policy,
                               const LinkOptions& options);

  /// What to do with a message.
  enum class Fate {
    Sent,  ///< send it to the readers present
    Kept,  ///< keep it until await() has found a reader
    Lost,  ///< drop it, since there is no reader, and call count_lost()
    End,   ///< end the link: all readers have left
  };
  /// Decides on the next message, given the number of readers present.
  Fate decide(std::size_t present);
  void count_lost(Traffic& traffic) const;

  /// Whether the link ends when the last reader leaves.
  [[nodiscard]] bool ends_with_readers() const {
    return has_begun_ && readers_ > 0 && !stays_ && !arrival_.is_over();
  }
  /// Whether closing the link must wait for readers, since nothing has been sent yet.
  [[nodiscard]] bool is_awaited() const { return !has_begun_ && readers_ > 0; }

  /// Waits for the readers of the next message, or the end: `wait` for the first message, `timeout`
  /// afterwards.
  /// @param descriptor  readable when the result of `present` may have changed
  /// @param present  the number of readers. Errors: those of `present`; Stopped, System.
  Status await(int descriptor, LinkOptions& options,
               const std::function<Result<std::size_t>()>& present);

 private:
  std::int64_t readers_ = 0;  // for the first message; 0: none; -1: one, which may leave
  bool stays_ = false, writer_waits_ = false;
  bool has_begun_ = false;  // the first message has been sent or lost
  Patience arrival_;        // for readers that have not connected yet
  Patience absence_;        // after all readers have left
};

}  // namespace hc::internal
