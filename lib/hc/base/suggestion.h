// SPDX-License-Identifier: Apache-2.0
#pragma once
// What somebody may have meant who misspelt a name. Pure.

#include <string>
#include <string_view>
#include <vector>

namespace hc {

/// ", did you mean "camera"?" where one of `known` is spelled nearly as `name`; else empty.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace hc
