// SPDX-License-Identifier: Apache-2.0
#pragma once
// Logging of the library: to a sink that the caller passes in. The library never prints.

#include <functional>
#include <string_view>

namespace hc {

enum class Level {
  Info,
  Warning,
  Error,   ///< an operation failed, although the program continues; `hc run` repeats it at its end
  Result,  ///< of the module's work, such as a score; `hc run` repeats it at its end
  Notice,  ///< for the person at the terminal only, such as a URL with its token; never published
};

/// Takes one line without a line end. Called on the thread that logs.
using LogSink = std::function<void(Level level, std::string_view line)>;

}  // namespace hc
