// SPDX-License-Identifier: Apache-2.0
#pragma once
// Suggests a known name for a misspelt one. Pure.

#include <string>
#include <string_view>
#include <vector>

namespace hc {

/// ", did you mean "camera"?" if one of `known` is similar to `name` or has a prefix; else empty.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace hc
