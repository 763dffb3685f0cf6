// SPDX-License-Identifier: Apache-2.0
#include "story.h"

#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::json;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

hc::Severity severity_of(std::string_view line) {
  if (line.find("error") != std::string_view::npos || line.find("failed") != std::string_view::npos)
    return hc::Severity::Error;
  if (line.find("warning") != std::string_view::npos) return hc::Severity::Warning;
  return hc::Severity::Info;
}

}  // namespace

std::unique_ptr<Story> Story::listen(const char* graph) {
  auto running = hc::parse_running(graph == nullptr ? "" : graph);
  if (!running) return nullptr;
  std::unique_ptr<Story> story(new Story(*running));
  hc::LinkOptions options;
  options.limits.element_bytes = hc::kMaxStateBytes;
  auto source = hc::open_source(*hc::parse_uri(running->state_uri()), options);
  if (!source) return nullptr;
  story->source_ = std::move(*source);
  return story;
}

Story::~Story() {
  is_ending_ = true;
  if (asker_.joinable()) asker_.join();
}

void Story::tell(hc::mcap::Recorder& recorder, std::int64_t now) {
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
    if (message.header.src == hc::kStateSource) tell_state(recorder, text);
    if (message.header.src != hc::kLogSource) continue;
    const auto colon = std::min(text.find(": "), text.size());
    const auto line = text.substr(std::min(colon + 2, text.size()));
    static_cast<void>(recorder.log(now, severity_of(line), text.substr(0, colon), line));
  }
  static_cast<void>(source_->prepare_wait());
  const std::lock_guard lock(mutex_);
  for (auto& [module, description] : std::exchange(answers_, {}))
    static_cast<void>(
        recorder.metadata("hypercolumn.description." + module, {{"json", description}}));
}

void Story::tell_state(hc::mcap::Recorder& recorder, std::string_view json) {
  const auto state = Json::parse(json, nullptr, false);
  if (!state.is_object()) return;
  auto tell_new = [&](const std::string& name, const hc::mcap::Words& words) {
    if (words == told_[name]) return;
    told_[name] = words;
    static_cast<void>(recorder.metadata(name, words));
  };
  const auto file = state.value("file", std::string());
  if (!told_.contains("hypercolumn.graph")) {
    std::ifstream in(file, std::ios::binary);
    tell_new("hypercolumn.graph", {{"name", state.value("graph", std::string())},
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
    tell_new("hypercolumn.module." + name, words);
  }
  if (!std::exchange(has_asked_, true)) ask_modules(names);
}

void Story::ask_modules(const std::vector<std::string>& names) {
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
