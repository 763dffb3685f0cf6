// SPDX-License-Identifier: Apache-2.0
#include "observer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <sstream>

#include <hc/base/suggestion.h>
#include <hc/mtp/rows.h>
#include <hc/os/program.h>

#include "common.h"

namespace tool {
namespace {

constexpr std::string_view kPrefix = "hypercolumn.", kAnswerPrefix = "hypercolumn-answer.";
constexpr std::int32_t kState = 1;                            // src of what a graph says of itself
constexpr std::uint64_t kMostSaid = std::uint64_t{16} << 20;  // [byte]
constexpr std::chrono::seconds kAnswerTime{10};
constexpr int kMostWaits = 12;                       // so long
constexpr std::chrono::milliseconds kSilence{5000};  // a graph speaks twice a second

std::string place(const RunningGraph& graph) {
  return fmt::format("unix:@{}{}", kPrefix, graph.text());
}

/// NAME.PROCESS, which stands behind the prefix in a socket's name. Anybody may bind any other.
std::optional<RunningGraph> parse(std::string_view word) {
  auto dot = word.find('.');
  if (dot == std::string_view::npos || dot == 0 || dot > kMaxGraphName) return std::nullopt;
  if (!std::all_of(word.begin(), word.begin() + dot, is_of_graph_name)) return std::nullopt;
  RunningGraph graph;
  graph.name = word.substr(0, dot);
  auto number = word.substr(dot + 1);
  auto [stop, status] =
      std::from_chars(number.data(), number.data() + number.size(), graph.process);
  if (status != std::errc() || stop != number.data() + number.size() || graph.process <= 0)
    return std::nullopt;
  return graph;
}

}  // namespace

bool is_of_graph_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

std::vector<RunningGraph> find_running(std::string_view sockets) {
  std::vector<RunningGraph> found;
  std::istringstream lines{std::string(sockets)};
  const std::string begin = "@" + std::string(kPrefix);
  for (std::string line; std::getline(lines, line);) {
    // Of those that listen alone; each connection to one stands there with its name too.
    std::istringstream words(line);
    std::string slot, references, protocol, flags, type, state, inode, path;
    words >> slot >> references >> protocol >> flags >> type >> state >> inode >> path;
    if (flags != "00010000" || !path.starts_with(begin)) continue;
    auto graph = parse(std::string_view(path).substr(begin.size()));
    if (graph) found.push_back(std::move(*graph));
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(a.name, a.process) < std::tie(b.name, b.process);
  });
  return found;
}

std::vector<RunningGraph> find_running() {
  std::ifstream table("/proc/net/unix");
  std::stringstream text;
  text << table.rdbuf();
  return find_running(text.str());
}

RunningGraph choose_running(const std::string& name) {
  auto all = find_running();
  std::vector<RunningGraph> meant;
  std::vector<std::string> names;
  for (const auto& graph : all) {
    names.push_back(graph.name);
    if (name.empty() || graph.name == name || graph.text() == name) meant.push_back(graph);
  }
  if (meant.size() == 1) return meant.front();
  if (meant.empty())
    throw Failure(hc::Error{hc::Code::NotFound,
                            name.empty() ? "no graph runs here"
                                         : fmt::format("no graph \"{}\" runs here{}", name,
                                                       hc::suggestion(name, names))});
  std::string list;
  for (const auto& graph : meant) list += (list.empty() ? "" : ", ") + graph.text();
  throw Failure(hc::Error{hc::Code::Invalid, "several graphs run: say which: " + list});
}

Observer::Observer(const RunningGraph& graph)
    : name_(graph.text()), source_(open_source(place(graph), kMostSaid)) {}

std::optional<nlohmann::json> Observer::next(int input) {
  std::optional<nlohmann::json> state;
  hc::Message message;
  while (true) {
    auto got = source_->take(message);
    if (!got || *got == hc::Got::End) return std::nullopt;
    if (*got == hc::Got::Message && message.header.src == kState) {
      auto json = nlohmann::json::parse(message.characters(), nullptr, false);
      if (json.is_object()) state = std::move(json);
    }
    if (*got == hc::Got::Message) continue;
    if (state) return state;
    std::array<int, 2> descriptors = {source_->descriptor(), input};
    auto ready = hc::wait_readable(std::span(descriptors).first(input >= 0 ? 2 : 1),
                                   hc::stop_descriptor(), kSilence);
    if (!ready && ready.error().code == hc::Code::Stopped) return std::nullopt;
    if (!ready) throw Failure(ready.error());
    if (input >= 0 && *ready == 1) return nlohmann::json::object();
    if (*ready == (input >= 0 ? 2U : 1U))
      throw Failure(
          hc::Error{hc::Code::Closed, name_ + " has said nothing for 5 s; it may be stopped"});
  }
}

std::optional<nlohmann::json> Observer::next_measured() {
  constexpr int kUnmeasured = 2;  // the first tells what was before, the second begins to measure
  for (int i = 0; i < kUnmeasured; ++i)
    if (!next()) return std::nullopt;
  return next();
}

void ask(const RunningGraph& graph, const std::vector<std::string>& commands) {
  const std::string answers = fmt::format("@{}{}", kAnswerPrefix, ::getpid());
  auto source = open_source("unix-listen:" + answers, kMostSaid);
  std::vector<std::string> rows = {"reply unix:" + answers};
  rows.insert(rows.end(), commands.begin(), commands.end());
  const std::string where = place(graph) + ".ask";
  auto sink = open_sink(where);
  send(*sink, hc::make_rows(rows), where);
  if (auto closed = sink->close(); !closed) throw Failure(where, closed.error());
  hc::Message message;
  int waits = 0;
  while (true) {
    auto got = source->take(message);
    if (!got) throw Failure(graph.text(), got.error());
    if (*got == hc::Got::Message) break;
    std::array<int, 1> descriptors = {source->descriptor()};
    auto ready = hc::wait_readable(descriptors, hc::stop_descriptor(), kAnswerTime);
    if (!ready) throw Failure(ready.error());
    if (*ready == 0) continue;
    // It may be asking a program that is slow; and has others to ask before.
    if (++waits == kMostWaits || !Observer(graph).next())
      throw Failure(hc::Error{hc::Code::Closed, graph.text() + " does not answer"});
  }
  auto answer = hc::rows_of(message);
  if (answer == std::vector<std::string>{"ok"}) return;
  for (std::size_t i = 0; i + 1 < answer.size(); ++i) say("hc graph: " + answer[i]);
  throw Failure(hc::Error{hc::Code::Invalid, answer.empty() ? "an empty answer" : answer.back()});
}

}  // namespace tool
