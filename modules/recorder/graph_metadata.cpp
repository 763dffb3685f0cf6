// SPDX-License-Identifier: Apache-2.0
#include "graph_metadata.h"

#include <fstream>
#include <iterator>

#include <record/reader.h>

GraphMetadata::GraphMetadata(hc::GraphClient& graph, hc::record::Writer& writer)
    : graph_(graph), writer_(writer) {
  // A graph that publishes no state has no metadata.
  static_cast<void>(graph_.watch(
      {.state = [this](const auto& state, auto) { record_state(state); },
       .log = [this](const auto& line, auto) { static_cast<void>(writer_.log(line)); }}));
}

void GraphMetadata::record(const std::string& name, const hc::mcap::StringMap& words) {
  if (words == recorded_[name]) return;
  recorded_[name] = words;
  static_cast<void>(writer_.metadata(name, words));
}

void GraphMetadata::record_state(const hc::GraphState& state) {
  const bool is_first = recorded_.empty();
  if (is_first) {
    std::ifstream file(state.file, std::ios::binary);
    record("hypercolumn.graph", {{"name", state.name},
                                 {"file", state.file},
                                 {"text", {std::istreambuf_iterator<char>(file), {}}}});
  }
  for (const auto& module : state.modules) {
    hc::mcap::StringMap words = {{"program", module.program}};
    for (const auto& [name, value] : module.parameters) words["parameter." + name] = value;
    record("hypercolumn.module." + module.name, words);
    if (is_first) undescribed_.push_back(module.name);
  }
  if (is_first) describe_next();
}

void GraphMetadata::describe_next() {
  if (undescribed_.empty()) return;
  const auto name = std::move(undescribed_.front());
  undescribed_.pop_front();
  graph_.command({"describe " + name}, [this, name](const auto& answer) {
    if (!answer) return;
    if (answer->is_ok && !answer->rows.empty())
      record(hc::record::kDescriptionPrefix + name,
             {{hc::record::kDescriptionKey, answer->rows.front()}});
    describe_next();
  });
}
