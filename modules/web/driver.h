// SPDX-License-Identifier: Apache-2.0
#pragma once
// What one who drives commands, from a page's messages (spec/page.md, W12 and W13), and that
// nothing is commanded when they stop. Pure: time is handed in.

#include <optional>
#include <set>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <hc/mtp/message.h>

/// The outputs of `web`, by the `src` of the page's messages.
enum class Control : std::int32_t { Alive, Stick, Rotation, Target, Text, Bid };
inline constexpr int kControls = 6;

struct Order {
  Control control = Control::Alive;
  hc::Message message;
};

class Driver {
 public:
  /// A driver who has sent nothing for so long commands nothing.
  static constexpr std::chrono::milliseconds kSilence{200};
  /// How often a bid is repeated.
  static constexpr std::chrono::milliseconds kBid{100};
  /// The image in which a target is may be so old, or ahead of the clock.
  static constexpr std::chrono::nanoseconds kOldest{1'000'000'000};

  /// Takes a message of the page, which gets the time of its arrival, but for a target: that has
  /// the time of its image.
  /// @param modes  the numbers of those that the graph has; @param wall  now [ns].
  /// @returns  what is to be sent. Errors: Malformed (not as the table says), Invalid (a target in
  ///     an image that is too old; nothing comes of it).
  hc::Result<std::vector<Order>> take(hc::Message message, const std::set<std::int32_t>& modes,
                                      std::int64_t wall, hc::MonotonicTime now);

  /// To be called every few milliseconds: repeats the bid, or ends what is commanded after silence.
  std::vector<Order> tick(std::int64_t wall, hc::MonotonicTime now);

  /// Ends what is commanded: the driver has left.
  std::vector<Order> leave(std::int64_t wall);

 private:
  hc::MonotonicTime heard_{}, bid_sent_{};
  bool is_pushed_ = false;          // the stick is out of its middle
  std::optional<hc::Message> bid_;  // that is repeated
};
