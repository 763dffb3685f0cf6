// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which readers a sink with several waits for: the options `readers`, `stay`, `wait`, and `timeout`
// for those that have left. One rule for all transports. Internal. Of the thread that sends.

#include <cstdint>
#include <functional>

#include <hc/link/link.h>
#include <hc/link/policy.h>

namespace hc::internal {

/// Waits until `descriptor` is readable or `until` has passed, and makes the call of
/// LinkOptions::interrupt when that is due, which is a reason to return too.
///
/// Errors: Stopped, System.
Status wait_for_event(int descriptor, LinkOptions& options, TimePoint until = TimePoint::max());

class Audience {
 public:
  /// @param most  of `readers`. @param policy  of the same URI. Errors: Invalid.
  static Result<Audience> make(const Uri& uri, std::int64_t most, const Policy& policy,
                               const LinkOptions& options);

  /// What becomes of a message.
  enum class Fate {
    Sent,  ///< to the readers that are present
    Kept,  ///< until await() has found a reader
    Lost,  ///< without a reader; count_lost() counts it
    End,   ///< all readers that were counted have left, and the link ends
  };
  /// Decides on the next message, with so many readers present.
  Fate decide(std::size_t present);
  void count_lost(Traffic& traffic) const;

  /// Whether the link ends when no reader is present.
  [[nodiscard]] bool ends_with_readers() const {
    return has_begun_ && readers_ > 0 && !stays_ && !arrival_.is_over();
  }
  /// Whether the link's end has to wait for its readers: nothing has been sent to them yet.
  [[nodiscard]] bool is_awaited() const { return !has_begun_ && readers_ > 0; }

  /// Waits for the readers of the next message, or the end: at first for `wait`, then for
  /// `timeout`.
  /// @param descriptor  readable when `present` may give another number
  /// @param present  the number of readers. Errors: those of `present`; Stopped, System.
  Status await(int descriptor, LinkOptions& options,
               const std::function<Result<std::size_t>()>& present);

 private:
  std::int64_t readers_ = 0;  // for the first message; 0: none, ever; below 0: one, not counted
  bool stays_ = false, writer_waits_ = false;
  bool has_begun_ = false;  // the first message has been sent, or lost
  Patience arrival_;        // with readers that have not connected yet
  Patience absence_;        // with all readers that have left
};

}  // namespace hc::internal
