// SPDX-License-Identifier: Apache-2.0
#pragma once
// Metadata of a recording: the graph, its modules, their parameters, and the log.

#include <deque>
#include <map>
#include <string>

#include <client/graph_client.h>
#include <record/writer.h>

/// Records a graph's log lines and changes of its metadata. The writer reports its own errors.
class GraphMetadata {
 public:
  GraphMetadata(hc::GraphClient& graph, hc::record::Writer& writer);

 private:
  void record_state(const hc::GraphState& state);
  void record(const std::string& name, const hc::mcap::StringMap& words);
  void describe_next();

  hc::GraphClient& graph_;
  hc::record::Writer& writer_;
  std::map<std::string, hc::mcap::StringMap> recorded_;  // latest metadata, by name
  std::deque<std::string> undescribed_;                  // modules
};
