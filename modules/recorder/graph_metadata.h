// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a recording says beside its messages: the graph, its modules, their parameters, the log.

#include <deque>
#include <map>
#include <string>

#include <client/graph_client.h>
#include <record/writer.h>

/// Records what a graph says of itself: log lines, and metadata that has changed. What cannot be
/// written, the writer tells by itself.
class GraphMetadata {
 public:
  GraphMetadata(hc::GraphClient& graph, hc::record::Writer& writer);

 private:
  void record_state(const hc::GraphState& state);
  void record(const std::string& name, const hc::mcap::StringMap& words);
  void describe_next();

  hc::GraphClient& graph_;
  hc::record::Writer& writer_;
  std::map<std::string, hc::mcap::StringMap> recorded_;  // the newest metadata, by name
  std::deque<std::string> undescribed_;                  // modules
};
