// SPDX-License-Identifier: Apache-2.0
#include <room/turns.h>

#include <algorithm>
#include <iterator>

namespace hc::room {

void Turns::add() {
  const double pause = chance_.next(times_.shortest_pause, times_.longest_pause);
  const double length = chance_.next(times_.shortest, times_.longest);
  const double draw = chance_.next();
  const int number = static_cast<int>(turns_.size());
  int person = std::min(static_cast<int>(draw * count_), count_ - 1);
  if (number > 0 && count_ > 1) {
    const int others = std::min(static_cast<int>(draw * (count_ - 1)), count_ - 2);
    person = (turns_.back().person + 1 + others) % count_;
  }
  const double begin = (number == 0 ? 0 : turns_.back().end) + pause;
  turns_.push_back({number, person, begin, begin + length});
}

std::optional<Turns::Turn> Turns::at(double t) {
  while (turns_.empty() || turns_.back().end <= t) add();
  const auto turn = std::ranges::upper_bound(turns_, t, {}, &Turn::end);
  if (turn == turns_.end() || t < turn->begin) return std::nullopt;
  return *turn;
}

}  // namespace hc::room
