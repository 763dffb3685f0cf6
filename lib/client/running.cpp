// SPDX-License-Identifier: Apache-2.0
#include <client/running.h>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <tuple>

#include <hc/os/peer_user.h>

namespace hc {
namespace {

/// Whether a process of this user has bound a graph's name, which any user may do.
bool is_own(const RunningGraph& graph) {
  const auto socket = connect_to(graph);
  if (!socket) return errno == EAGAIN;  // a full queue; the user is checked when it answers
  const auto user = unix_peer_user(socket->get());
  return user && *user == ::geteuid();
}

}  // namespace

Result<Descriptor> connect_to(const RunningGraph& graph) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = graph.command_uri().substr(std::string_view("unix:@").size());
  name.copy(address.sun_path + 1, sizeof address.sun_path - 1);
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0)
    return Error{Code::Closed,
                 graph.text() + (errno == EAGAIN ? " does not answer" : " has ended")};
  return socket;
}

std::optional<RunningGraph> own_graph() {
  const char* name = std::getenv("HC_GRAPH");
  return parse_running_graph(name == nullptr ? "" : name);
}

std::vector<RunningGraph> find_running(std::string_view sockets) {
  std::vector<RunningGraph> found;
  std::istringstream lines{std::string(sockets)};
  const std::string begin = "@" + std::string(RunningGraph::kPrefix);
  for (std::string line; std::getline(lines, line);) {
    // Only listening sockets: connections carry the same name.
    std::istringstream words(line);
    std::string slot, references, protocol, flags, type, state, inode, path;
    words >> slot >> references >> protocol >> flags >> type >> state >> inode >> path;
    if (flags != "00010000" || !path.starts_with(begin)) continue;
    auto graph = parse_running_graph(std::string_view(path).substr(begin.size()));
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

}  // namespace hc
