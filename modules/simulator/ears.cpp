// SPDX-License-Identifier: Apache-2.0
#include "ears.h"

#include <room/sounds.h>
#include "schedule.h"

namespace {

const Eigen::Vector3d kLoudspeaker(2.4, -1.6, 0.7);  // in the world [m]

}  // namespace

void Ears::hear_until(hc::Time until, const Eigen::Isometry3d& T_world_head) {
  const auto heard = start_ + period_end(sample_, hc::room::kSoundRate);
  if (was_set(until, heard)) start_ += until - heard;
  const auto end = (until - start_) * hc::room::kSoundRate / std::chrono::seconds(1);
  if (end <= sample_) return;
  if (sound_.linked()) {
    auto draft = sound_.loan(1, static_cast<std::int32_t>(end - sample_));
    draft.header.time = start_ + period_end(sample_, hc::room::kSoundRate);
    for (const std::size_t side : {0U, 1U}) {
      const double distance = (T_world_head * places_[side] - kLoudspeaker).norm();
      hc::room::hear(sample_, distance, draft.matrix().numbers().subspan(side), 2);
    }
    sound_.send(std::move(draft));
  }
  sample_ = end;
}
