// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads a target from a message.

#include <frames/messages.h>

/// A target: its position and coordinate system.
struct Seen {
  std::int32_t coord = 0;
  Eigen::Vector3d p;  ///< [px] in an image, else [m]
};

/// The target in a position (x y z), a pose (its origin, in the frame coord / 1000), or a table of
/// markers (the first, in the frame coord). Nothing if the message is empty or not finite.
inline std::optional<Seen> seen_of(const hc::Message& message) {
  const auto& header = message.header;
  constexpr int kPlace = 3;  // column of x in a table of markers
  Seen seen{header.coord, {}};
  if (header.empty()) return std::nullopt;
  if (header.info.type == hc::MatrixType::Transformation) {
    const auto T = hc::value_or_drop(hc::as_eigen<double>(message));
    seen = {header.coord / 1000, T.topRightCorner<3, 1>()};
  } else {
    const auto numbers = hc::value_or_drop(hc::as_eigen<double>(message));
    const int from = header.info.type == hc::MatrixType::Table ? kPlace : 0;
    if (numbers.cols() < from + 3) return std::nullopt;
    seen.p = numbers.block<1, 3>(0, from).transpose();
  }
  return seen.p.allFinite() ? std::optional(seen) : std::nullopt;
}
