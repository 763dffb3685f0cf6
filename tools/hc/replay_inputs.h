// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a module that is replayed gets: its steps, by its recorded trace, and its messages.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hc/base/uri.h>
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
  /// The events before a step.
  [[nodiscard]] std::span<const hc::TraceEvent> before(const hc::TraceEvent& step) const;
  /// The steps to replay: the start, as an event with only a moment, then each handler, each change
  /// of a parameter, and each reading of the clock.
  [[nodiscard]] std::vector<hc::TraceEvent> steps() const;
};

/// A link by which recorded messages go to a module again.
struct Feed {
  std::string output;       ///< their sender
  std::string port;         ///< the module's input
  std::int32_t number = 0;  ///< among the links of the port
  /// What the link does to them, which the recording is without; from the message with this `seq`.
  std::map<std::int64_t, hc::Conversion> conversions = {};
  std::string hindrance = {};  ///< why the messages that it sent are unknown; empty: none

  /// Adds what a link with this URI does. @param seq  of its first message.
  void add(std::int64_t seq, hc::Uri uri);
  /// Adds what commands changed while the graph was recorded.
  /// @param trace  of the sender. @param reader  "MODULE.PORT".
  void add_changes(const RecordedTrace& trace, const std::string& reader);

  /// Writes its messages to a file, as the link sends them.
  void write_all(const GraphRecording& recording, const std::filesystem::path& to) const;
  /// Writes those that were handled. Drops the first steps if their messages were not recorded, and
  /// all from the next such one on, which is returned: its message came from elsewhere, or was
  /// lost.
  std::optional<hc::TraceEvent> write_handled(const GraphRecording& recording,
                                              std::vector<hc::TraceEvent>& steps,
                                              const std::filesystem::path& to) const;

 private:
  template <typename IsWanted>
  void write(const GraphRecording& recording, const std::filesystem::path& to,
             const IsWanted& is_wanted) const;
};

/// Writes a trace, for `--clock`.
void write_steps(const std::vector<hc::TraceEvent>& steps, const std::filesystem::path& to);

}  // namespace tool
