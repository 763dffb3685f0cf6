// SPDX-License-Identifier: Apache-2.0
#pragma once
// The order of numbered names: 2 before 10. Pure.

#include <string_view>

namespace hc {

/// Compares names with their numbers as numbers: "2.png" < "10.png". Names that differ only in
/// leading zeros are in the order of their bytes.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace hc
