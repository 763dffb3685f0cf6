// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a library's remarks go: to a sink that its user hands in. The library never prints.

#include <functional>
#include <string_view>

namespace hc {

/// What a line of a log is for.
enum class Level {
  Info,
  Warning,
  Error,   ///< something was not done although the work goes on; `hc run` repeats it at its end
  Result,  ///< of the module's work, such as a score; `hc run` repeats it at its end
  Notice,  ///< for the person at the terminal alone, such as a URL with its token; never published
};

/// Takes one line without its end. Called on the thread that has something to say.
using LogSink = std::function<void(Level level, std::string_view line)>;

}  // namespace hc
