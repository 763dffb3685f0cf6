// SPDX-License-Identifier: Apache-2.0
#include "words.h"

#include <algorithm>
#include <filesystem>

#include <hc/base/format.h>
#include <hc/base/place_word.h>
#include <hc/contract/description.h>
#include <hc/os/program.h>

#include "observer.h"

namespace tool {
namespace {

namespace fs = std::filesystem;

/// Whether a word can be MODULE.PORT.
bool may_be_port(const std::string& word) {
  return hc::is_port_name(word) && !is_recording_file(word);
}

bool has_port(const RunningGraph& graph, const std::string& word) {
  const auto dot = word.find('.');
  const auto port = word.substr(dot + 1);
  const auto answer = hc::ask(graph, {"describe " + word.substr(0, dot)}, hc::stop_descriptor());
  if (!answer || !answer->is_ok || answer->rows.empty()) return false;
  const auto description = hc::parse_description(answer->rows.front());
  return description && (hc::find_input(*description, port) != nullptr ||
                         hc::find_output(*description, port) != nullptr);
}

/// Whether a word is a port of the graph that choose_running() chooses, or of one of those that it
/// cannot choose from.
bool is_running_port(const std::string& word, const std::string& of) {
  if (!may_be_port(word)) return false;
  auto graphs = find_running();
  if (graphs.empty()) return false;
  try {
    graphs = {choose_running(of)};
  } catch (const Failure&) {
    if (!of.empty()) throw;
  }
  return std::ranges::any_of(graphs, [&](const auto& graph) { return has_port(graph, word); });
}

}  // namespace

bool is_recording_file(const std::string& word) {
  return word.ends_with(".mtp") || hc::is_mcap_path(word);
}

std::optional<RunningGraph> graph_of_port(const std::string& word, const std::string& of) {
  std::error_code missing;
  if (!may_be_port(word)) return std::nullopt;
  if (fs::exists(word, missing) && !is_running_port(word, of)) return std::nullopt;
  if (of.empty() && find_running().empty())
    throw Failure(hc::Code::NotFound, word + ": no such file, and no graph is running here");
  return choose_running(of);
}

hc::record::Place place_of(const std::string& word, const std::string& of) {
  const auto graph = graph_of_port(word, of);
  if (!graph) return value_or_fail(hc::record::place_of(word));
  hc::record::Place place{hc::record::Place::Kind::Link, {}, {}, {}};
  place.uri = value_or_fail(hc::tap_uri(*graph, word, hc::stop_descriptor()));
  place.uri.options.emplace_back("reconnect", "5");  // survives a restart of the module
  return place;
}

std::unique_ptr<hc::Source> open_named(const std::string& word, const std::string& of,
                                       std::uint64_t limit) {
  const auto graph = graph_of_port(word, of);
  if (!graph) return open_source(word, limit);
  auto opened = hc::open_tap(*graph, word, link_options(limit));
  if (opened) return std::move(*opened);
  throw Failure(opened.error().code,
                (of.empty() ? word + ": no such file, and " : "") + opened.error().detail);
}

void check_output(const std::string& word) {
  if (is_running_port(word, ""))
    throw Failure(
        hc::Code::Invalid,
        hc::format("{} is a port of a running graph: to record it, add an output FILE; to "
                   "send to it, use hc send --to {}; for a file of that name, write ./{}",
                   word, word, word));
}

std::unique_ptr<hc::Sink> open_output(const std::string& word) {
  check_output(word);
  return open_sink(word);
}

std::string link_end(const std::string& word) {
  const bool is_path = word.find('/') != std::string::npos || is_recording_file(word);
  if (!is_path || value_or_fail(hc::record::place_of(word)).kind == hc::record::Place::Kind::Link ||
      word.starts_with("file:"))
    return word;
  return "file:" + fs::absolute(word).lexically_normal().string();
}

}  // namespace tool
