// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a recording says beside its messages: the graph, its modules, their parameters, the log.

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <client/graph_client.h>
#include <client/running.h>
#include <record/writer.h>

/// Observes the graph that one is a module of.
class GraphMetadata {
 public:
  /// Null where there is no such graph, or nobody publishes its state.
  static std::unique_ptr<GraphMetadata> observe(const std::optional<hc::RunningGraph>& graph);
  ~GraphMetadata();

  /// Readable when record() has something to do.
  [[nodiscard]] int descriptor() const { return source_ != nullptr ? source_->descriptor() : -1; }
  /// Records what is new: log lines, and metadata that has changed.
  void record(hc::record::Writer& writer);

 private:
  explicit GraphMetadata(hc::RunningGraph graph) : graph_(std::move(graph)) {}
  void record_state(hc::record::Writer& writer, std::string_view json);
  void ask_modules(const std::vector<std::string>& names);

  hc::RunningGraph graph_;
  std::unique_ptr<hc::Source> source_;
  std::map<std::string, hc::mcap::Words> recorded_;  // the newest metadata, by name
  std::thread asker_;                                // for descriptions
  std::mutex mutex_;
  std::vector<std::pair<std::string, std::string>> answers_;  // modules and their descriptions
  std::atomic<bool> is_ending_{false};
  bool has_asked_ = false;
};
