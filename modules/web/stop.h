// SPDX-License-Identifier: Apache-2.0
#pragma once
// The stop, as the pages want it, and what the workspace says of it (spec/page.md, W8). Pure: time
// is handed in.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/clock.h>

class Stop {
 public:
  /// What is sent by the output `stop`.
  enum class Word : std::uint8_t {
    Free = 0,       ///< no stop, but somebody is there who could press it
    Stop = 1,       ///< to be repeated for as long as it is wanted
    Clear = 2,      ///< a person clears the stops of all sources; see tick()
    Unguarded = 3,  ///< nobody is there any more
  };
  /// How often what is wanted is repeated.
  static constexpr std::chrono::milliseconds kPeriod{50};
  /// So long the workspace has to confirm an order.
  static constexpr std::chrono::milliseconds kPatience{500};
  /// From the first page on that opens, so that others repeat what was pressed without a server.
  static constexpr std::chrono::milliseconds kFirst{1500};
  /// The server thread hangs after this time without a turn.
  static constexpr std::chrono::milliseconds kHung{200};
  /// How often it is said that nobody is there any more.
  static constexpr int kFarewells = 3;
  /// What it said counts for so long.
  static constexpr std::chrono::milliseconds kSilence{1000};

  /// Called once: with an empty text when the workspace has confirmed, else with what is wrong.
  using Answer = std::function<void(const std::string& problem)>;

  /// @param module  name of the module in the graph, for what is told to persons.
  explicit Stop(std::string module) : module_(std::move(module)) {}

  /// A person wants the robot to stop, or clears all stops. An order before that is not confirmed
  /// yet is answered: as confirmed later where it is the same, else that it is not wanted any more.
  /// @param is_linked  whether the output `stop` has a link.
  /// @returns  what is to be sent at once.
  Word order(bool stops, bool is_linked, hc::MonotonicTime now, Answer answer);

  /// The workspace says whether the robot is stopped.
  void hear(bool is_stopped, hc::MonotonicTime now);

  /// To be called each kPeriod.
  /// @param is_guarded  whether a page is open; nothing: the server thread hangs, and only a stop
  /// is repeated.
  /// @returns  the word to be sent, if any. Clear is repeated until a workspace that can confirm it
  /// does, which may have restarted without it, and with the time of its order, so that newer stops
  /// hold.
  std::optional<Word> tick(std::optional<bool> is_guarded, hc::MonotonicTime now);

  /// What the workspace said last; nothing: it is silent, or was never heard.
  [[nodiscard]] std::optional<bool> is_stopped(hc::MonotonicTime now) const;

 private:
  struct Order {
    bool stops = false;
    hc::MonotonicTime due;
    Answer answer;
  };

  /// Answers those orders of which `is_settled` is true.
  template <typename IsSettled, typename Problem>
  void answer(const IsSettled& is_settled, const Problem& problem_of);
  [[nodiscard]] std::string problem(const Order& order) const;

  const std::string module_;
  bool is_wanted_ = false;
  bool has_cleared_ = false;                // since the last tick
  std::optional<hc::MonotonicTime> first_;  // when a page was open
  int farewells_ = 0;                       // still to be sent
  std::optional<bool> heard_;
  hc::MonotonicTime heard_at_{};
  std::vector<Order> orders_;  // not confirmed yet
};
