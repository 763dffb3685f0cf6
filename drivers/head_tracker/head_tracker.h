// SPDX-License-Identifier: Apache-2.0
#pragma once
// Receives the UDP packets of a head tracker, as sent by opentrack.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <drivers/head_tracker/pose.h>
#include <drivers/head_tracker/senders.h>
#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc {

/// A pose and the arrival of its packet.
struct TimedHeadPose {
  HeadPose pose;
  Time time;
};

/// Called with problems that may be frequent; logs the first of a kind and counts the others.
using Problem = std::function<void(const std::string& kind, std::string_view line)>;

/// Receives packets. For one thread.
class HeadTracker {
 public:
  /// @param host  an address of this machine: "127.0.0.1", "0.0.0.0" for all, "::1".
  /// @param port  0 takes a free one.
  ///
  /// Errors: Invalid (no address), System (the port is in use, …).
  static Result<HeadTracker> open(const std::string& host, int port, Senders senders);

  /// Takes the newest pose and discards older ones; nothing without a valid packet. Never blocks.
  ///
  /// @param problem  called for each ignored packet.
  ///
  /// Errors: System.
  Result<std::optional<TimedHeadPose>> receive(MonotonicTime now, const Problem& problem);

  /// For poll().
  [[nodiscard]] int descriptor() const { return socket_.get(); }
  [[nodiscard]] int port() const { return port_; }

 private:
  HeadTracker(Descriptor socket, int port, Senders senders)
      : socket_(std::move(socket)), port_(port), senders_(std::move(senders)) {}

  Descriptor socket_;
  int port_ = 0;
  Senders senders_;
};

}  // namespace hc
