// SPDX-License-Identifier: Apache-2.0
#include <people/hand_command.h>

#include <algorithm>
#include <utility>

namespace hc::people {
namespace {

double farthest_apart(const HandCommand::Directions& a, const HandCommand::Directions& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

}  // namespace

std::optional<Sign> HandCommand::update(Time time, Sign sign, const Directions& towards) {
  const bool was_unseen = std::chrono::abs(time - std::exchange(last_, time)) > kUnseen;
  const double palm = (towards[1] - towards[0]).norm();
  const bool has_moved = sign != Sign::None && farthest_apart(towards, from_) > kStill * palm;
  if (was_unseen || has_moved) {
    hold_ = SignHold{kHold};
    from_ = towards;
  }
  return hold_.update(time, sign);
}

}  // namespace hc::people
