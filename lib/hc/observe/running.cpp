// SPDX-License-Identifier: Apache-2.0
#include <hc/observe/running.h>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <tuple>

#include <hc/base/format.h>
#include <hc/mtp/rows.h>
#include <hc/os/descriptor.h>
#include <hc/os/peer_user.h>

namespace hc {
namespace {

constexpr std::string_view kPrefix = "hypercolumn.", kAnswerPrefix = "hypercolumn-answer.";
constexpr std::chrono::seconds kAnswerTime{10};
constexpr int kMaxWaits = 12;  // so long

Result<std::unique_ptr<Source>> open_source_at(const std::string& uri, int stop) {
  auto parsed = parse_uri(uri);
  if (!parsed) return parsed.error();
  LinkOptions options;
  options.limits.element_bytes = kMaxStateBytes;
  options.stop = stop;
  return open_source(*parsed, options);
}

Result<std::unique_ptr<Sink>> open_sink_at(const std::string& uri, int stop = -1) {
  auto parsed = parse_uri(uri);
  if (!parsed) return parsed.error();
  LinkOptions options;
  options.stop = stop;
  return open_sink(*parsed, options);
}

/// Whether who listens under a graph's name is a process of this user: anybody may take a name.
bool is_own(const RunningGraph& graph) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = hc::format("{}{}", kPrefix, graph.text());
  name.copy(address.sun_path + 1, sizeof address.sun_path - 1);
  const internal::Descriptor socket(
      ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0)
    return errno == EAGAIN;  // it has not accepted for long; who it is, is found when it answers
  const auto user = internal::unix_peer_user(socket.get());
  return user && *user == ::geteuid();
}

/// Whether a graph says anything: it sends its state to whoever connects.
bool is_alive(const RunningGraph& graph, int stop) {
  auto source = open_source_at(graph.state_uri(), stop);
  if (!source) return false;
  auto is_there = (*source)->wait(stop, kSilence);
  return is_there && *is_there;
}

}  // namespace

bool is_of_graph_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

std::string RunningGraph::state_uri() const {
  return hc::format("unix:@{}{}", kPrefix, text());
}

std::optional<RunningGraph> parse_running(std::string_view text) {
  const auto dot = text.find('.');
  if (dot == std::string_view::npos || dot == 0 || dot > kMaxGraphName) return std::nullopt;
  RunningGraph graph;
  graph.name = text.substr(0, dot);
  if (!std::ranges::all_of(graph.name, is_of_graph_name)) return std::nullopt;
  const char *begin = text.data() + dot + 1, *end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(begin, end, graph.process);
  if (status != std::errc() || stop != end || graph.process <= 0) return std::nullopt;
  return graph;
}

std::optional<RunningGraph> own_graph() {
  const char* name = std::getenv("HC_GRAPH");
  return parse_running(name == nullptr ? "" : name);
}

std::vector<RunningGraph> find_running(std::string_view sockets) {
  std::vector<RunningGraph> found;
  std::istringstream lines{std::string(sockets)};
  const std::string begin = "@" + std::string(kPrefix);
  for (std::string line; std::getline(lines, line);) {
    // Of those that listen alone; each connection to one is there with its name too.
    std::istringstream words(line);
    std::string slot, references, protocol, flags, type, state, inode, path;
    words >> slot >> references >> protocol >> flags >> type >> state >> inode >> path;
    if (flags != "00010000" || !path.starts_with(begin)) continue;
    auto graph = parse_running(std::string_view(path).substr(begin.size()));
    if (graph) found.push_back(std::move(*graph));
  }
  std::ranges::sort(found, [](const auto& a, const auto& b) {
    return std::tie(a.name, a.process) < std::tie(b.name, b.process);
  });
  return found;
}

std::vector<RunningGraph> find_running() {
  std::ifstream table("/proc/net/unix");
  std::stringstream text;
  text << table.rdbuf();
  auto graphs = find_running(text.str());
  std::erase_if(graphs, [](const auto& graph) { return !is_own(graph); });
  return graphs;
}

Result<Answer> ask(const RunningGraph& graph, const std::vector<std::string>& commands, int stop) {
  static std::atomic<unsigned> asked{0};
  const std::string answers = hc::format("@{}{}.{}", kAnswerPrefix, ::getpid(), asked++);
  auto source = open_source_at("unix-listen:" + answers, stop);
  if (!source) return source.error();
  std::vector<std::string> rows = {"reply unix:" + answers};
  rows.insert(rows.end(), commands.begin(), commands.end());
  auto sink = open_sink_at(graph.command_uri(), stop);
  if (!sink) return sink.error();
  if (auto sent = (*sink)->send(make_rows(rows)); !sent) return sent.error();
  if (auto closed = (*sink)->close(); !closed) return closed.error();
  Message message;
  for (int waits = 0;;) {
    auto got = (*source)->take(message);
    if (!got) return got.error();
    if (*got == Got::Message) break;
    auto ready = (*source)->wait(stop, kAnswerTime);
    if (!ready) return ready.error();
    // It may be waiting for a slow program, or have others to answer first.
    if (!*ready && (++waits == kMaxWaits || !is_alive(graph, stop)))
      return Error{Code::Closed, graph.text() + " does not answer"};
  }
  Answer answer;
  answer.rows = rows_of(message);
  answer.is_ok = !answer.rows.empty() && answer.rows.front() == "ok";
  if (answer.is_ok)
    answer.rows.erase(answer.rows.begin());
  else if (answer.rows.empty())
    answer.rows.emplace_back("an empty answer");
  return answer;
}

Result<Observation> Observation::make(const RunningGraph& graph, const std::string& port,
                                      int stop) {
  Observation made;
  made.command_ = "observe " + port;
  auto answer = ask(graph, {made.command_}, stop);
  if (!answer) return answer.error();
  if (!answer->is_ok || answer->rows.empty())
    return Error{Code::Invalid, answer->is_ok ? "no URI in the answer" : answer->rows.back()};
  const auto& uri = answer->rows.front();
  made.uri_ = uri + (uri.find('?') == std::string::npos ? "?" : "&") + "reconnect=86400";
  auto sink = open_sink_at(graph.command_uri(), stop);
  if (!sink) return sink.error();
  made.sink_ = std::move(*sink);
  return made;
}

bool Observation::renew() {
  return sink_->send(make_rows(std::array{command_})).has_value();
}

}  // namespace hc
