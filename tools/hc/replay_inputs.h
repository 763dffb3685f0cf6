// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a module that is replayed gets: its steps, by its recorded trace, and its messages.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <hc/compress/convert.h>
#include <hc/contract/trace.h>

#include "graph_recording.h"

namespace tool {

/// The input by which a module gets the focus, in traces.
inline constexpr const char* kFocus = "focus";

/// The recorded trace of a module.
struct RecordedTrace {
  std::vector<hc::TraceEvent> events;  ///< none: missing, or events or messages were dropped
  bool was_restarted = false;

  static RecordedTrace read(const GraphRecording& recording, const std::string& module);

  /// The events up to the end of the last complete step. The module was stopped during the rest, or
  /// did not report it; the rest is not replayed.
  [[nodiscard]] std::span<const hc::TraceEvent> whole() const;
  /// The steps to replay: the start, as an event with only a moment, then each handler, each change
  /// of a parameter, and each reading of the clock.
  [[nodiscard]] std::vector<hc::TraceEvent> steps() const;
};

/// A link by which recorded messages go to a module again.
struct Feed {
  std::string output;         ///< their sender
  std::string port;           ///< the module's input
  std::int32_t number = 0;    ///< among the links of the port
  hc::Conversion conversion;  ///< what the link does to them, which the recording is without
  bool is_adapted = false;    ///< to a bandwidth: in what form is unknown

  /// Writes its messages to a file, as the link sends them.
  void write_all(const GraphRecording& recording, const std::filesystem::path& to) const;
  /// Writes those that were handled; drops steps whose message was not recorded.
  void write_handled(const GraphRecording& recording, std::vector<hc::TraceEvent>& steps,
                     const std::filesystem::path& to) const;

 private:
  template <typename IsWanted>
  void write(const GraphRecording& recording, const std::filesystem::path& to,
             const IsWanted& is_wanted) const;
};

/// Writes a trace, for `--clock`.
void write_steps(const std::vector<hc::TraceEvent>& steps, const std::filesystem::path& to);

}  // namespace tool
