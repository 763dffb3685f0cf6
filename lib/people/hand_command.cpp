// SPDX-License-Identifier: Apache-2.0
#include <people/hand_command.h>

#include <utility>

namespace hc::people {
namespace {

bool is_still(const HandCommand::Directions& from, const HandCommand::Directions& to) {
  const double most = HandCommand::kStill * (to[1] - to[0]).norm();
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!((from[i] - to[i]).norm() <= most)) return false;
  return true;
}

}  // namespace

std::optional<Sign> HandCommand::update(Time time, Sign sign,
                                        const std::optional<Directions>& towards) {
  const auto passed = time - std::exchange(last_, time);
  const bool was_unseen = std::chrono::abs(passed) > kUnseen;
  const bool has_moved = towards && !(from_ && is_still(*from_, *towards));
  if (was_unseen || has_moved) {
    hold_ = SignHold{kHold};
    from_ = towards;
    // It came to rest between the two images: on average, in the middle.
    if (!was_unseen) hold_.update(time - passed / 2, sign);
  }
  return hold_.update(time, sign);
}

}  // namespace hc::people
