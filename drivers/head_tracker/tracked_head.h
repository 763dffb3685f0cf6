// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tracks a person's head: listens as soon as the port is free, returns poses relative to a zero,
// and logs each change. Never blocks.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <drivers/head_tracker/head_tracker.h>
#include <hc/base/backoff.h>
#include <hc/base/clock.h>
#include <hc/base/log.h>

namespace hc {

struct TrackedHeadOptions {
  std::string host;  ///< host, port: as in HeadTracker::open(); "": does not listen
  int port = 0;
  std::vector<std::string> senders;  ///< other accepted hosts, as in Senders
  /// Time without a pose until that is logged and another sender is accepted.
  std::chrono::nanoseconds silence = std::chrono::seconds(1);
  bool centre_first = true;  ///< the first pose is the zero; else the tracker's
};

/// For one thread.
class TrackedHead {
 public:
  static constexpr std::chrono::milliseconds kLook{20};  ///< period of pass()

  TrackedHead(TrackedHeadOptions options, LogSink log, Problem problem)
      : options_(std::move(options)), log_(std::move(log)), problem_(std::move(problem)) {}

  /// Opens the port, retrying while it is in use, and logs a silence.
  ///
  /// Errors: Invalid (the host is not an address).
  Status pass(MonotonicTime now);
  /// For poll(); -1 while it does not listen.
  [[nodiscard]] int descriptor() const { return tracker_ ? tracker_->descriptor() : -1; }
  /// The listening address, "127.0.0.1:4242"; empty while it does not listen.
  [[nodiscard]] const std::string& address() const { return address_; }
  /// Takes the newest pose, relative to the zero; nothing if none has arrived.
  ///
  /// Errors: System.
  Result<std::optional<TimedHeadPose>> receive(MonotonicTime now);
  /// Makes the next pose the zero.
  void centre() { centres_next_ = true; }

 private:
  Status listen(MonotonicTime now);

  TrackedHeadOptions options_;
  LogSink log_;
  Problem problem_;
  std::optional<HeadTracker> tracker_;
  Backoff backoff_;
  std::string address_;
  // Time of the last pose or of the start of listening; nothing once a silence is logged.
  std::optional<MonotonicTime> active_;
  bool receives_ = false, is_first_ = true, centres_next_ = false;
  HeadPose zero_;
};

}  // namespace hc
