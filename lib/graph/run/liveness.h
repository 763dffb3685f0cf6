// SPDX-License-Identifier: Apache-2.0
#pragma once
// Signs of life of a process. Pure: the time is a parameter. Internal to graph.

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <hc/base/clock.h>
#include <hc/os/procfs.h>

namespace hc::internal {

/// What the silence of a process means.
enum class Health {
  Responsive,  ///< it reports, or it never has
  Blocked,     ///< it waits for the reader of an output
  Busy,
  Stopped,  ///< by a signal
};

/// For how long a process has not reported, and for how long it has waited for a reader.
class Liveness {
 public:
  void reported(bool is_blocked, MonotonicTime now) {
    reported_ = now;
    excuse();
    blocked_ = is_blocked ? blocked_.value_or(now) : std::optional<MonotonicTime>();
  }

  /// Called now and then. The time between two calls counts at most 1 s as silence, since this
  /// process itself may have been stopped or starved; without the time for which the other one has
  /// waited for a processor, once it is silent for a second.
  ///
  /// @param usage  measures the process; called only where it matters.
  template <typename Measure>
  void check(bool is_running, MonotonicTime now, const Measure& usage) {
    constexpr MonotonicTime kMostAtOnce = std::chrono::seconds(1), kShort = std::chrono::seconds(1);
    const auto before = std::exchange(checked_, now);
    if (!is_running || !before) return;
    silence_ += std::min(now - *before, kMostAtOnce);
    if (silence_ < kShort) return waited_.reset();
    const auto total = usage().waited;
    if (waited_ && total == waited_->total) return;  // that of another host comes once a second
    if (waited_)
      silence_ -= std::clamp(total - waited_->total, MonotonicTime(0),
                             std::min(silence_, now - waited_->measured));
    waited_ = Waited{total, now};
  }

  /// Its silence has another cause.
  void excuse() {
    silence_ = MonotonicTime(0);
    waited_.reset();
  }
  /// The process has ended.
  void forget() { *this = Liveness(checked_); }

  [[nodiscard]] bool has_reported() const { return reported_.has_value(); }
  /// Without reports while it could have sent some, as far as checked.
  [[nodiscard]] MonotonicTime silence() const { return silence_; }
  [[nodiscard]] std::optional<MonotonicTime> blocked_since() const { return blocked_; }

  /// @param stall  time without a report after which a process that has reported is not responsive.
  /// @param usage  measures the process; called only where it matters.
  template <typename Measure>
  [[nodiscard]] Health health(MonotonicTime stall, MonotonicTime now, const Measure& usage) const {
    if (reported_ && now - *reported_ < stall) return Health::Responsive;
    if (usage().is_stopped) return Health::Stopped;
    if (!reported_) return Health::Responsive;
    return blocked_ ? Health::Blocked : Health::Busy;
  }

  /// The time of silence after which the process hangs; nullopt: it does not. Spares a process in a
  /// debugger, and one that waits for a reader.
  ///
  /// @param hang  0: never.
  /// @param first_report  least time for the first report, for loading libraries; nullopt: it may
  /// never report.
  template <typename Measure>
  [[nodiscard]] std::optional<MonotonicTime> hung_after(MonotonicTime hang,
                                                        std::optional<MonotonicTime> first_report,
                                                        const Measure& usage) const {
    if (hang == MonotonicTime(0) || silence_ < hang) return {};
    const Usage found = usage();
    if (found.is_traced || (blocked_ && !found.is_stopped)) return {};
    if (reported_ || found.is_stopped) return hang;
    if (!first_report || silence_ < *first_report) return {};
    return std::max(hang, *first_report);
  }

  Liveness() = default;

 private:
  explicit Liveness(std::optional<MonotonicTime> checked) : checked_(checked) {}

  std::optional<MonotonicTime> reported_, checked_;
  MonotonicTime silence_{0};
  struct Waited {
    MonotonicTime total, measured;
  };
  std::optional<Waited> waited_;          // for a processor
  std::optional<MonotonicTime> blocked_;  // since then
};

/// The share of a processor that a process and its descendants use.
class ProcessorMeter {
 public:
  /// @param usage  measured `now`.
  void measure(const Usage& usage, MonotonicTime now) {
    if (measured_ && now > *measured_)
      processor_ = std::max(0.0, std::chrono::duration<double>(usage.processor - usage_.processor) /
                                     std::chrono::duration<double>(now - *measured_));
    usage_ = usage;
    measured_ = now;
  }

  [[nodiscard]] double processor() const { return processor_; }
  [[nodiscard]] const Usage& usage() const { return usage_; }

 private:
  Usage usage_;
  std::optional<MonotonicTime> measured_;
  double processor_ = 0;
};

}  // namespace hc::internal
