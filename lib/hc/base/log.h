// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a library's remarks go: to a sink that its user hands in. The library never prints.

#include <functional>
#include <string_view>

namespace hc {

enum class Severity { Info, Warning, Error };

/// Takes one line without its end. Called on the thread that has something to say.
using LogSink = std::function<void(Severity, std::string_view line)>;

}  // namespace hc
