// SPDX-License-Identifier: Apache-2.0
#include "ears.h"

#include <algorithm>

#include "schedule.h"

void Ears::hear_until(hc::Time until, const Eigen::Isometry3d& T_world_head,
                      std::span<const hc::room::Source> sources) {
  const auto heard = start_ + period_end(sample_, hc::room::kSoundRate);
  if (was_set(until, heard)) start_ += until - heard;
  const auto end = (until - start_) * hc::room::kSoundRate / std::chrono::seconds(1);
  if (end <= sample_) return;
  if (sound_.linked()) {
    auto draft = sound_.loan(1, static_cast<std::int32_t>(end - sample_));
    draft.header.time = start_ + period_end(sample_, hc::room::kSoundRate);
    const auto samples = draft.matrix().numbers();
    std::ranges::fill(samples, std::int16_t{0});
    for (const std::size_t side : {0U, 1U})
      for (const auto& source : sources) {
        const double distance = (T_world_head * places_[side] - source.place).norm();
        hc::room::hear(sample_, distance, source.sound, samples.subspan(side), 2);
      }
    sound_.send(std::move(draft));
  }
  sample_ = end;
}
