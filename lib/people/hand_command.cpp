// SPDX-License-Identifier: Apache-2.0
#include <people/hand_command.h>

#include <utility>

namespace hc::people {

std::optional<Sign> HandCommand::update(Time time, Sign sign, const Eigen::Vector3d& towards,
                                        double palm) {
  const bool was_unseen = std::chrono::abs(time - std::exchange(last_, time)) > kUnseen;
  const bool has_moved = sign != Sign::None && (towards - from_).norm() > kStill * palm;
  if (was_unseen || has_moved) {
    hold_ = SignHold{kHold};
    from_ = towards;
  }
  return hold_.update(time, sign);
}

}  // namespace hc::people
