// SPDX-License-Identifier: Apache-2.0
#include "eye_sets.h"

#include <hc/mtp/coords.h>

using hc::Coord;

namespace {

bool is_depth(const hc::Header& header) {
  return header.coord == Coord::kDepth || header.coord == Coord::kRightDepth;
}

bool is_right(const hc::Header& header) {
  return header.coord == Coord::kRightImage || header.coord == Coord::kRightRectified ||
         header.coord == Coord::kRightDepth;
}

}  // namespace

EyeSets::EyeSets(bool is_pair, bool is_fog, const Take& take) : is_pair_(is_pair), is_fog_(is_fog) {
  // Where the eyes, or image and depth, are not joined, there is a group for each.
  const std::size_t inputs = is_pair && is_fog ? 4 : 2;
  if (!is_pair && !is_fog) return;
  for (std::size_t i = 0; i < 4 / inputs; ++i)
    groups_.push_back({hc::Matcher(inputs, take), std::vector<std::uint64_t>(inputs)});
}

bool EyeSets::is_whole(const hc::Header& header) const {
  // Disparities and their confidence, and other measured images, are of one eye only.
  const bool is_image = header.info.scalar == hc::Scalar::U8 && header.coord != Coord::kDisparity;
  const bool is_of_eyes = is_depth(header) || is_image;
  return groups_.empty() || !is_of_eyes;
}

EyeSets::Place EyeSets::place_of(const hc::Header& header) const {
  const std::size_t depth = is_depth(header) ? 1 : 0, right = is_right(header) ? 1 : 0;
  if (!is_fog_) return {depth, right};
  if (!is_pair_) return {right, depth};
  return {0, 2 * depth + right};
}

std::string EyeSets::name_of(Place place) const {
  const bool is_depth = !is_fog_ ? place.group == 1 : place.place >= (is_pair_ ? 2U : 1U);
  const bool is_right = is_fog_ && !is_pair_ ? place.group == 1 : place.place % 2 == 1;
  return std::string(is_depth ? "depth" : "image") + " of the " + (is_right ? "right" : "left") +
         " eye";
}

void EyeSets::push(const hc::Message& message) {
  const auto [group, place] = place_of(message.header);
  ++groups_[group].came[place];
  groups_[group].matcher.push(place, message.keep());
}

std::string EyeSets::missing(bool is_end) const {
  std::string names;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    bool is_overdue = false;
    for (std::size_t i = 0; i < group.came.size(); ++i)
      is_overdue |= group.came[i] > 0 && (is_end || group.matcher.dropped(i).crowded > 0);
    for (std::size_t i = 0; is_overdue && i < group.came.size(); ++i)
      if (group.came[i] == 0) names += (names.empty() ? "" : ", ") + name_of({g, i});
  }
  return names;
}
