// SPDX-License-Identifier: Apache-2.0
#pragma once
// Pairs the image files of two folders by their names. Pure.

#include <filesystem>
#include <vector>

using Paths = std::vector<std::filesystem::path>;

/// Files of two eyes; left[i] and right[i] belong together.
struct Partners {
  Paths left, right;
  Paths alone;  ///< those without a partner
};

/// Pairs files whose names are equal, apart from the ending; or whose numbers are; or whose last
/// number is ("cam0_left_12.png", "cam1_right_12.png"): by what gives most pairs, if no two files
/// of a folder agree in it. There may be no pairs.
/// @param left, right  in the order of the result.
Partners partners_of(const Paths& left, const Paths& right);
