// SPDX-License-Identifier: Apache-2.0
#pragma once
// Who of several persons acts when: one at a time, for random times. Pure.

#include <cstdint>
#include <optional>
#include <vector>

#include <room/chance.h>

namespace hc::room {

/// Times of turns [s].
struct TurnTimes {
  double shortest, longest;              ///< turn
  double shortest_pause, longest_pause;  ///< before it
};

class Turns {
 public:
  /// @param count  of persons, at least 1.
  Turns(int count, const TurnTimes& times, std::uint64_t seed)
      : count_(count), times_(times), chance_(seed) {}

  struct Turn {
    int number;         ///< from 0
    int person;         ///< another one each time, if there are several
    double begin, end;  ///< [s]
  };
  /// The turn at a time, if it is anyone's.
  [[nodiscard]] std::optional<Turn> at(double t);

 private:
  void add();

  int count_;
  TurnTimes times_;
  Chance chance_;
  std::vector<Turn> turns_;
};

}  // namespace hc::room
