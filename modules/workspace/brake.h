// SPDX-License-Identifier: Apache-2.0
#pragma once
// The sources that stop or guard the robot. Pure: times come from the caller.
//
// The rules, for each source of the input `stop` separately:
// - 1 stops the robot, until the same process of that source sends 0, or any source sends 2, with
//   which a person clears all earlier stops. A source may have forgotten its stop if it repeated
//   its 1 and was then silent for kSilence, if it has left, or if its `seq` restarted: then its 0
//   clears nothing until it has stopped the robot again.
// - A source guards from the second of two 0 that are at most kSilence apart: it announces that it
//   can stop the robot at any time. While a guard is silent for longer, no mode may have the focus,
//   since its stop could not arrive. A 3 ends its guarding, and so does another source's 2 while it
//   is silent.
// - 1 always counts. Other words count from the time they were sent, and are refused if older than
//   kOld or more than kAhead in the future.

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
  /// The words of a source.
  static constexpr std::uint8_t kFree = 0, kStop = 1, kClearAll = 2, kLeave = 3;
  static constexpr std::chrono::milliseconds kSilence{300}, kOld{1000}, kAhead{200};
  /// Maximum number of sources. A stop of one more holds until all stops are cleared.
  static constexpr std::size_t kMostSources = 64;
  static constexpr std::int32_t kOthers = -1;  ///< in stops(): sources beyond the limit

  /// A message of a source.
  struct Message {
    std::int32_t source = 0;
    std::uint8_t word = kStop;
    std::int64_t seq = 0;  ///< decreases when the source's process has restarted
    hc::MonotonicTime said{};
  };

  /// Errors: Malformed (unknown word; too old or from the future), TooLarge (too many sources, and
  /// not a stop).
  hc::Status take(const Message& message, hc::MonotonicTime now);

  /// Restores the state of the previous process: its stops hold until cleared as after a silence,
  /// and its guards are silent.
  void restore(const hc::Stops& stops);
  /// The state for restore() in the next process.
  [[nodiscard]] hc::Stops stops() const;

  [[nodiscard]] bool is_stopped() const { return hc::any_stops(stops()); }
  [[nodiscard]] bool stops_robot(std::int32_t source) const {
    const auto found = sources_.find(source);
    return found != sources_.end() && found->second.stops;
  }
  /// Why no mode may have the focus: "stopped by web.stop", "source 14 is silent: its stop could
  /// not arrive"; empty if one may.
  [[nodiscard]] std::string reason(hc::MonotonicTime now) const;

  void set_names(std::map<std::int32_t, std::string> names) { names_ = std::move(names); }
  /// @see hc::source_name()
  [[nodiscard]] std::string name(std::int32_t source) const {
    return hc::source_name(source, names_);
  }

 private:
  struct Source {
    bool stops = false, guards = false;
    bool is_forgetful = false;   // its 0 does not clear its stop
    std::uint8_t word = kLeave;  // last
    bool repeats = false;        // the last word was sent twice within kSilence
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
  bool others_stop_ = false;  // stopped by a source beyond kMostSources
};
