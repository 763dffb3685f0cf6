// SPDX-License-Identifier: Apache-2.0
#pragma once
// Turns a page's messages into the driver's commands (spec/page.md, W12 and W13), and ends the
// commands when the messages stop. Pure: times come from the caller.

#include <optional>
#include <set>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <hc/mtp/message.h>

/// The outputs of `web`; the values are the `src` of the page's messages.
enum class Control : std::int32_t { Alive, Stick, Rotation, Target, Text, Bid, Name, Hold };
inline constexpr int kControls = 8;

struct Order {
  Control control = Control::Alive;
  hc::Message message;
};

class Driver {
 public:
  /// After this silence, all commands end.
  static constexpr std::chrono::milliseconds kSilence{200};
  /// Period of a bid.
  static constexpr std::chrono::milliseconds kBid{100};
  /// Maximum age of a target's image, and maximum time ahead of the clock.
  static constexpr std::chrono::nanoseconds kOldest{1'000'000'000};

  /// Takes a message of the page and stamps it with its arrival; a target keeps its image's time.
  /// @param modes  of the graph. @param wall  now [ns].
  /// @returns  the commands to send. Errors: Malformed (does not match the table), Invalid (the
  ///     image of a target is too old; the target is ignored).
  hc::Result<std::vector<Order>> take(hc::Message message, const std::set<std::int32_t>& modes,
                                      hc::Time wall, hc::MonotonicTime now);

  /// Call every few milliseconds: repeats the bid, or ends the commands after a silence.
  std::vector<Order> tick(hc::Time wall, hc::MonotonicTime now);

  /// Ends the commands when the driver leaves.
  std::vector<Order> leave(hc::Time wall);

 private:
  hc::MonotonicTime heard_{}, bid_sent_{};
  bool is_pushed_ = false;          // the stick
  bool is_holding_ = false;         // on to a person
  std::optional<hc::Message> bid_;  // repeated
};
