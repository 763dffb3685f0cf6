// SPDX-License-Identifier: Apache-2.0
#pragma once
// A recording of `hc run --record`: a folder of MODULE.PORT.mtp, or an MCAP file.

#include <memory>
#include <set>
#include <string>

#include <hc/link/link.h>
#include <record/place.h>

namespace tool {

class GraphRecording {
 public:
  /// @param place  a folder, or a file whose name ends in ".mcap". Fails if it does not exist.
  explicit GraphRecording(const std::string& place);

  /// "MODULE.PORT", including the traces of modules.
  [[nodiscard]] const std::set<std::string>& outputs() const { return outputs_; }
  [[nodiscard]] bool has(const std::string& output) const { return outputs_.contains(output); }

  /// Opens a recorded output.
  [[nodiscard]] std::unique_ptr<hc::Source> open(const std::string& output) const;
  /// Takes the next message; false at the end, or when asked to stop. If the recorder was killed,
  /// the last whole message is the end.
  bool receive(hc::Source& source, hc::Message& message, const std::string& output) const;

  /// The graph file that was run, as named in an MCAP file; empty: unknown.
  [[nodiscard]] const std::string& graph_file() const { return graph_file_; }

  /// The place of an output's messages, for error messages.
  [[nodiscard]] std::string place_of(const std::string& output) const;

 private:
  const hc::record::Place place_;
  std::set<std::string> outputs_;
  std::string graph_file_;
};

}  // namespace tool
