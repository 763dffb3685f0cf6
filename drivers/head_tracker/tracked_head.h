// SPDX-License-Identifier: Apache-2.0
#pragma once
// A person's head by a tracker: listens once the port is free, gives poses since a zero, and logs a
// line for each change. Never waits.

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
  std::string host;  ///< and port: as of HeadTracker::open(); no host: it does not listen
  int port = 0;
  std::vector<std::string> senders;  ///< other hosts that are heard, as of Senders
  /// Without a pose for so long it is logged, and another sender may be heard.
  std::chrono::nanoseconds silence = std::chrono::seconds(1);
  bool centre_first = true;  ///< the first pose is the zero; else the tracker's
};

/// For one thread.
class TrackedHead {
 public:
  static constexpr std::chrono::milliseconds kLook{20};  ///< how often pass() is to be called

  TrackedHead(TrackedHeadOptions options, LogSink log, Problem problem)
      : options_(std::move(options)), log_(std::move(log)), problem_(std::move(problem)) {}

  /// Opens the port, retrying while it is in use, and logs when no pose has come for a while.
  ///
  /// Errors: Invalid (the host is no address).
  Status pass(MonotonicTime now);
  /// For poll(); -1 while it does not listen.
  [[nodiscard]] int descriptor() const { return tracker_ ? tracker_->descriptor() : -1; }
  /// Where it listens, "127.0.0.1:4242"; empty while it does not.
  [[nodiscard]] const std::string& address() const { return address_; }
  /// The newest pose that has come, since the zero; nothing where none has.
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
  // When the last pose came, or listening began; nothing: silence was logged.
  std::optional<MonotonicTime> active_;
  bool receives_ = false, is_first_ = true, centres_next_ = false;
  HeadPose zero_;
};

}  // namespace hc
