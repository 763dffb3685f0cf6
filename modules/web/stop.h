// SPDX-License-Identifier: Apache-2.0
#pragma once
// The stop requested by the pages, and its confirmation by the workspace (spec/page.md, W8). Pure:
// times come from the caller.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/clock.h>

class Stop {
 public:
  /// Sent by the output `stop`.
  enum class Word : std::uint8_t {
    Free = 0,       ///< no stop, and a page is open where it can be pressed
    Stop = 1,       ///< repeated until cleared
    Clear = 2,      ///< a person clears the stops of all sources; see tick()
    Unguarded = 3,  ///< no page is open any more
  };
  /// Period of the word.
  static constexpr std::chrono::milliseconds kPeriod{50};
  /// Timeout for the workspace's confirmation of an order.
  static constexpr std::chrono::milliseconds kPatience{500};
  /// Delay of Free after the first page opens, so that others can first repeat a stop that was
  /// pressed while there was no server.
  static constexpr std::chrono::milliseconds kFirst{1500};
  /// The server's thread counts as hung after this time without a turn.
  static constexpr std::chrono::milliseconds kHung{200};
  /// Number of times that Unguarded is sent.
  static constexpr int kFarewells = 3;
  /// How long a report of the workspace is valid.
  static constexpr std::chrono::milliseconds kSilence{1000};

  /// Called once: with "" when the workspace has confirmed the order, else with the error.
  using Answer = std::function<void(const std::string& problem)>;

  /// @param module  name of the module in the graph, for error texts.
  explicit Stop(std::string module) : module_(std::move(module)) {}

  /// A person stops the robot, or clears all stops. Unconfirmed earlier orders of the same kind are
  /// confirmed together with it; the others are answered as superseded.
  /// @param is_linked  whether the output `stop` has a link.
  /// @returns  the word to send at once.
  Word order(bool stops, bool is_linked, hc::MonotonicTime now, Answer answer);

  /// Takes the workspace's report whether the robot is stopped.
  void hear(bool is_stopped, hc::MonotonicTime now);

  /// Call each kPeriod.
  /// @param is_guarded  whether a page is open; nothing if the server's thread hangs: then only a
  /// stop is repeated.
  /// @returns  the word to send, if any. Clear is repeated until confirmed, since the workspace may
  /// have restarted meanwhile, and with the time of its order, so that newer stops hold.
  std::optional<Word> tick(std::optional<bool> is_guarded, hc::MonotonicTime now);

  /// The last report of the workspace; nothing if it is silent.
  [[nodiscard]] std::optional<bool> is_stopped(hc::MonotonicTime now) const;

 private:
  struct Order {
    bool stops = false;
    hc::MonotonicTime due;
    Answer answer;
  };

  /// Answers the orders for which `is_settled` is true.
  template <typename IsSettled, typename Problem>
  void answer(const IsSettled& is_settled, const Problem& problem_of);
  [[nodiscard]] std::string problem(const Order& order) const;

  const std::string module_;
  bool is_wanted_ = false;
  bool has_cleared_ = false;                // since the last tick
  std::optional<hc::MonotonicTime> first_;  // when a page was first open
  int farewells_ = 0;                       // Unguarded still to send
  std::optional<bool> heard_;
  hc::MonotonicTime heard_at_{};
  std::vector<Order> orders_;  // not confirmed yet
};
