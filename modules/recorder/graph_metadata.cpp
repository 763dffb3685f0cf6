// SPDX-License-Identifier: Apache-2.0
#include "graph_metadata.h"

#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::json;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::unique_ptr<GraphMetadata> GraphMetadata::observe(
    const std::optional<hc::RunningGraph>& graph) {
  if (!graph) return nullptr;
  std::unique_ptr<GraphMetadata> metadata(new GraphMetadata(*graph));
  hc::LinkOptions options;
  options.limits.element_bytes = hc::kMaxStateBytes;
  auto source = hc::open_source(*hc::parse_uri(graph->state_uri()), options);
  if (!source) return nullptr;
  metadata->source_ = std::move(*source);
  return metadata;
}

GraphMetadata::~GraphMetadata() {
  is_ending_ = true;
  if (asker_.joinable()) asker_.join();
}

void GraphMetadata::record(hc::record::Writer& writer) {
  if (source_ == nullptr) return;
  hc::Message message;
  while (true) {
    auto got = source_->take(message);
    if (!got || *got == hc::Got::End) {
      source_.reset();
      return;
    }
    if (*got == hc::Got::Nothing) break;
    const auto text = message.characters();
    if (message.header.src == static_cast<int>(hc::GraphReport::State)) record_state(writer, text);
    if (message.header.src == static_cast<int>(hc::GraphReport::Log)) {
      if (const auto line = hc::parse_log_line(text)) static_cast<void>(writer.log(*line));
    }
  }
  static_cast<void>(source_->prepare_wait());
  const std::lock_guard lock(mutex_);
  for (auto& [module, description] : std::exchange(answers_, {}))
    static_cast<void>(
        writer.metadata("hypercolumn.description." + module, {{"json", description}}));
}

void GraphMetadata::record_state(hc::record::Writer& writer, std::string_view json) {
  const auto state = Json::parse(json, nullptr, false);
  if (!state.is_object()) return;
  auto record_new = [&](const std::string& name, const hc::mcap::Words& words) {
    if (words == recorded_[name]) return;
    recorded_[name] = words;
    static_cast<void>(writer.metadata(name, words));
  };
  const auto file = state.value("file", std::string());
  if (!recorded_.contains("hypercolumn.graph")) {
    std::ifstream in(file, std::ios::binary);
    record_new("hypercolumn.graph", {{"name", state.value("graph", std::string())},
                                     {"file", file},
                                     {"text", {std::istreambuf_iterator<char>(in), {}}}});
  }
  std::vector<std::string> names;
  for (const auto& module : state.value("modules", Json::array())) {
    if (!module.is_object()) continue;
    const auto name = module.value("name", std::string());
    names.push_back(name);
    hc::mcap::Words words = {{"program", module.value("program", std::string())}};
    const auto parameters = module.value("parameters", Json::object());
    for (const auto& [parameter, value] : parameters.items())
      words["parameter." + parameter] = text_of(value);
    record_new("hypercolumn.module." + name, words);
  }
  if (!std::exchange(has_asked_, true)) ask_modules(names);
}

void GraphMetadata::ask_modules(const std::vector<std::string>& names) {
  asker_ = std::thread([this, names] {
    for (const auto& name : names) {
      if (is_ending_) return;
      auto answer = hc::ask(graph_, {"describe " + name});
      if (!answer) return;
      if (!answer->is_ok || answer->rows.empty()) continue;
      const std::lock_guard lock(mutex_);
      answers_.emplace_back(name, answer->rows.front());
    }
  });
}
