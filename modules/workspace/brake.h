// SPDX-License-Identifier: Apache-2.0
#pragma once
// Who has stopped the robot, and who guards it. Pure: time is handed in.
//
// The rules, for each source of the input `stop` by itself:
// - A 1 stops the robot. It holds until the same process of that source sends a 0, or any source a
//   2: a person clears all stops made before. A source that repeated its 1 and was then silent for
//   kSilence, or has left, or whose `seq` has begun again, may have forgotten its stop: its 0
//   clears nothing until it has stopped the robot again.
// - A source guards from the second of two 0 on that are no further apart than kSilence: it can
//   stop the robot at any time, and says so. While it is silent for longer, nobody may move the
//   robot, since a stop could not arrive. A 3 says that it leaves and guards no more; a 2 of
//   another source dismisses it while it is silent.
// - A 1 always counts. Another word counts from when it was said, and not at all when that was kOld
//   ago or kAhead to come.

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <hc/contract/stops.h>

class Brake {
 public:
  /// What a source may say.
  static constexpr std::uint8_t kFree = 0, kStop = 1, kClearAll = 2, kLeave = 3;
  static constexpr std::chrono::milliseconds kSilence{300}, kOld{1000}, kAhead{200};
  /// Sources that are known at the same time. A stop of one more holds until all are cleared.
  static constexpr std::size_t kMostSources = 64;
  static constexpr std::int32_t kOthers = -1;  ///< no source: those beyond, in stops()

  /// What a source says.
  struct Message {
    std::int32_t source = 0;
    std::uint8_t word = kStop;
    std::int64_t seq = 0;  ///< of the message; falls when another process has begun to count
    hc::MonotonicTime said{};
  };

  /// Errors: Malformed (no such word; said at another time), TooLarge (one source too many, which
  /// does not stop).
  hc::Status take(const Message& message, hc::MonotonicTime now);

  /// What the process before has left: its stops hold until they are cleared as after a silence,
  /// and its guards are silent.
  void restore(const hc::Stops& stops);
  /// What is to outlive this process.
  [[nodiscard]] hc::Stops stops() const;

  [[nodiscard]] bool is_stopped() const { return hc::any_stops(stops()); }
  [[nodiscard]] bool stops_robot(std::int32_t source) const {
    const auto found = sources_.find(source);
    return found != sources_.end() && found->second.stops;
  }
  /// The reason why no mode may have the focus: "stopped by web.stop", "source 14 is silent: its
  /// stop could not arrive"; empty: there is none.
  [[nodiscard]] std::string reason(hc::MonotonicTime now) const;

  /// The names of sources.
  void set_names(std::map<std::int32_t, std::string> names) { names_ = std::move(names); }
  /// A source's name, or "source 14".
  [[nodiscard]] std::string name(std::int32_t source) const {
    const auto found = names_.find(source);
    return found == names_.end() ? "source " + std::to_string(source) : found->second;
  }

 private:
  struct Source {
    bool stops = false, guards = false;
    bool is_forgetful = false;   // its 0 ends no stop
    std::uint8_t word = kLeave;  // the last
    bool repeats = false;        // the last word was said twice within kSilence
    std::int64_t seq = 0;
    hc::MonotonicTime heard{std::chrono::hours(-1)};

    [[nodiscard]] bool is_silent(hc::MonotonicTime now) const { return now - heard > kSilence; }
    [[nodiscard]] bool matters() const { return stops || guards; }
  };

  Source* find(std::int32_t number);
  static void hear(Source& source, const Message& message, hc::MonotonicTime said);
  void clear_all(std::int32_t by, hc::MonotonicTime said);

  std::map<std::int32_t, std::string> names_;
  std::map<std::int32_t, Source> sources_;
  bool others_stop_ = false;  // a source beyond kMostSources
};
