// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `hc run --record` wrote of a graph: a folder of MODULE.PORT.mtp, or one file of MCAP.

#include <memory>
#include <set>
#include <string>

#include <hc/link/link.h>
#include <record/place.h>

namespace tool {

class GraphRecording {
 public:
  /// @param place  a folder, or a file whose name ends in ".mcap". Fails where there is none.
  explicit GraphRecording(const std::string& place);

  /// "MODULE.PORT", with the traces of modules.
  [[nodiscard]] const std::set<std::string>& outputs() const { return outputs_; }
  [[nodiscard]] bool has(const std::string& output) const { return outputs_.contains(output); }

  /// The messages of an output that it has.
  [[nodiscard]] std::unique_ptr<hc::Source> open(const std::string& output) const;
  /// Takes the next of these; false at their end, or when we are asked to stop. Where who wrote the
  /// recording was killed, that is the end of what is whole.
  bool receive(hc::Source& source, hc::Message& message, const std::string& output) const;

  /// The graph file that was run, which a file of MCAP names; empty: it names none.
  [[nodiscard]] const std::string& graph_file() const { return graph_file_; }

  /// Where an output's messages are, for a person.
  [[nodiscard]] std::string place_of(const std::string& output) const;

 private:
  const hc::record::Place place_;
  std::set<std::string> outputs_;
  std::string graph_file_;
};

}  // namespace tool
