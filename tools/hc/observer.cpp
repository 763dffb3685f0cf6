// SPDX-License-Identifier: Apache-2.0
#include "observer.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>
#include <hc/os/program.h>
#include <hc/os/wait_readable.h>

#include "common.h"

namespace tool {
namespace {

constexpr char kGranted = 'u';  // begins the URI of an observation; no code of an error

bool is_of_this_terminal(int process) {
  return ::getsid(process) == ::getsid(0);
}

bool is_of_this_folder(int process) {
  std::error_code unknown;
  const auto folder = std::filesystem::read_symlink(hc::format("/proc/{}/cwd", process), unknown);
  return !unknown && folder == std::filesystem::current_path(unknown);
}

/// Whether it is spelled as MODULE.PORT.
bool is_port_name(std::string_view text) {
  auto is_word = [](std::string_view word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
  };
  const auto dot = text.find('.');
  return dot != std::string_view::npos && is_word(text.substr(0, dot)) &&
         is_word(text.substr(dot + 1));
}

}  // namespace

RunningGraph choose_running(const std::string& wanted) {
  const char* variable = std::getenv("HC_GRAPH");
  const std::string name = !wanted.empty() || variable == nullptr ? wanted : variable;
  auto graphs = find_running();
  std::vector<std::string> names;
  names.reserve(graphs.size());
  for (const auto& graph : graphs) names.push_back(graph.name);
  std::erase_if(graphs, [&](const auto& graph) {
    return !name.empty() && graph.name != name && graph.text() != name;
  });
  if (graphs.empty())
    throw Failure(hc::Error{hc::Code::NotFound,
                            name.empty() ? "no graph is running here"
                                         : hc::format("no graph \"{}\" is running{}", name,
                                                      hc::suggestion(name, names))});
  for (bool (*is_near)(int) : {is_of_this_terminal, is_of_this_folder}) {
    if (graphs.size() == 1 || !name.empty()) break;
    std::vector<RunningGraph> near;
    for (const auto& graph : graphs)
      if (is_near(graph.process)) near.push_back(graph);
    if (near.size() == 1) return near.front();
  }
  if (graphs.size() == 1) return graphs.front();
  std::string list;
  for (const auto& graph : graphs) list += (list.empty() ? "" : ", ") + graph.text();
  throw Failure(
      hc::Error{hc::Code::Invalid, "several graphs are running; pass --of NAME: " + list});
}

Observer::Observer(const RunningGraph& graph)
    : name_(graph.text()), source_(open_source(graph.state_uri(), hc::kMaxStateBytes)) {}

std::optional<hc::GraphState> Observer::next(const std::vector<int>& inputs) {
  bool is_new = false;
  hc::Message message;
  while (true) {
    auto got = source_->take(message);
    if (!got || *got == hc::Got::End) return std::nullopt;
    if (*got == hc::Got::Message && message.header.src == hc::kStateSource) {
      state_ = value_or_fail(hc::parse_graph_state(message.characters()), name_);
      is_new = true;
    }
    if (*got == hc::Got::Message) continue;
    if (is_new) return state_;
    std::vector<int> descriptors = {source_->descriptor()};
    descriptors.insert(descriptors.end(), inputs.begin(), inputs.end());
    auto ready = hc::wait_readable(descriptors, hc::stop_descriptor(), hc::kSilence);
    if (!ready && ready.error().code == hc::Code::Stopped) return std::nullopt;
    if (!ready) throw Failure(ready.error());
    if (*ready == descriptors.size())
      throw Failure(
          hc::Error{hc::Code::Closed, name_ + " has not answered for 5 s; it may be stopped"});
    if (*ready > 0) return state_;
  }
}

std::optional<hc::GraphState> Observer::next_measured() {
  constexpr int kUnmeasured = 2;  // the first is older than this observer, the second measures
  for (int i = 0; i < kUnmeasured; ++i)
    if (!next()) return std::nullopt;
  return next();
}

std::vector<std::string> command_graph(const RunningGraph& graph,
                                       const std::vector<std::string>& commands) {
  auto answer = value_or_fail(hc::ask(graph, commands, hc::stop_descriptor()), graph.text());
  if (answer.is_ok) return answer.rows;
  for (std::size_t i = 0; i + 1 < answer.rows.size(); ++i) say("hc: " + answer.rows[i]);
  throw Failure(hc::Error{hc::Code::Invalid, answer.rows.back()});
}

Observation make_observation(const RunningGraph& graph, const std::string& port) {
  auto made = Observation::make(graph, port, hc::stop_descriptor());
  if (!made) throw Failure(made.error());
  return std::move(*made);
}

std::string observe(const RunningGraph& graph, const std::string& port) {
  std::array<int, 2> ends{};
  const pid_t parent = ::getpid();
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Failure({hc::Code::System, "pipe2"});
  // Before this process has any link, and so threads.
  const pid_t child = ::fork();
  if (child < 0) throw Failure({hc::Code::System, "fork"});
  if (child > 0) {
    ::close(ends[1]);
    std::string answer;
    char piece[512];
    for (ssize_t size = 0; (size = ::read(ends[0], piece, sizeof piece)) > 0;)
      answer.append(piece, static_cast<std::size_t>(size));
    ::close(ends[0]);
    const auto code = static_cast<hc::Code>(answer.empty() ? '\0' : answer.front());
    if (answer.starts_with(kGranted)) return answer.substr(1);
    throw Failure(
        {answer.empty() ? hc::Code::System : code, answer.empty() ? "ended" : answer.substr(1)});
  }
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(0);
  auto reply = [&](char kind, const std::string& text) {
    static_cast<void>(hc::write_all(ends[1], kind + text));
    ::close(ends[1]);
  };
  try {
    auto observation = make_observation(graph, port);
    reply(kGranted, observation.uri());
    // Whoever reads our parent's output is not to wait for us.
    for (int number : {STDIN_FILENO, STDOUT_FILENO}) ::close(number);
    do {
      ::sleep(1);
    } while (observation.renew());
    ::kill(parent, SIGTERM);
  } catch (const Failure& failure) {
    reply(static_cast<char>(failure.code), failure.detail);
  }
  ::_exit(0);
}

bool is_running_port(const std::string& text, const std::string& of) {
  if (!is_port_name(text) || find_running().empty()) return false;
  const auto dot = text.find('.');
  const auto name = text.substr(0, dot), port = text.substr(dot + 1);
  try {
    const auto described = command_graph(choose_running(of), {"describe " + name});
    const auto description = hc::parse_description(described.empty() ? "" : described.front());
    return description && (hc::find_input(*description, port) != nullptr ||
                           hc::find_named(description->outputs, port) != nullptr);
  } catch (const Failure&) {
    return false;  // one of several graphs may be meant, or it is another user's
  }
  return false;
}

std::string source_uri(const std::string& text, const std::string& of) {
  if (!is_port_name(text) && of.empty()) return text;
  std::error_code missing;
  const bool is_file = std::filesystem::exists(text, missing);
  if (of.empty() && is_file && !is_running_port(text, of)) return text;
  if (of.empty() && find_running().empty())
    throw Failure({hc::Code::NotFound, text + ": no such file, and no graph is running here"});
  try {
    return observe(choose_running(of), text);
  } catch (const Failure& failure) {
    if (is_file || !of.empty()) throw;
    throw Failure({failure.code, text + ": no such file, and " + failure.detail});
  }
}

}  // namespace tool
