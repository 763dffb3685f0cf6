// SPDX-License-Identifier: Apache-2.0
#include <graph/plan/routes.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

namespace hc::internal {
namespace {

class Network {
 public:
  Network(const std::vector<RoutedLink>& links, const std::vector<bool>& is_router)
      : links_(links), is_router_(is_router), leaving_(is_router.size()) {
    for (std::size_t i = 0; i < links.size(); ++i)
      if (is_router_at(links[i].from)) leaving_[links[i].from].push_back(i);
  }

  [[nodiscard]] bool is_router_at(std::size_t module) const {
    return module < is_router_.size() && is_router_[module];
  }

  /// A path from a router.
  struct Path {
    std::size_t first_link = 0;
    std::size_t routers = 1;  ///< on the path
  };

  /// The shortest path from a router to each address.
  [[nodiscard]] std::map<std::int64_t, Path> shortest_paths(std::size_t router) const {
    std::map<std::int64_t, Path> paths;
    std::map<std::size_t, Path> reached = {{router, {}}};  // routers
    std::deque<std::size_t> next = {router};               // breadth first
    for (; !next.empty(); next.pop_front())
      for (std::size_t i : leaving_[next.front()]) {
        const RoutedLink& link = links_[i];
        Path path = reached.at(next.front());
        if (next.front() == router) path.first_link = i;
        for (std::int64_t address : link.given ? *link.given : std::vector{link.reaches})
          if (address > 0) paths.emplace(address, path);
        if (is_router_at(link.to) &&
            reached.emplace(link.to, Path{path.first_link, path.routers + 1}).second)
          next.push_back(link.to);
      }
    return paths;
  }

 private:
  const std::vector<RoutedLink>& links_;
  const std::vector<bool>& is_router_;
  std::vector<std::vector<std::size_t>> leaving_;  // outgoing links, by router
};

}  // namespace

Routes compute_routes(const std::vector<RoutedLink>& links, const std::vector<bool>& is_router) {
  const Network network(links, is_router);
  Routes routes;
  std::vector<std::set<std::int64_t>> passed(links.size());
  for (std::size_t router = 0; router < is_router.size(); ++router)
    if (is_router[router])
      for (const auto& [address, path] : network.shortest_paths(router)) {
        passed[path.first_link].insert(address);
        routes.longest = std::max(routes.longest, path.routers);
      }
  for (std::size_t i = 0; i < links.size(); ++i) {
    auto& addresses = routes.passed.emplace_back();
    if (!network.is_router_at(links[i].from)) continue;
    passed[i].insert(kAll);
    if (links[i].given)
      addresses = *links[i].given;
    else
      addresses.assign(passed[i].begin(), passed[i].end());
  }
  return routes;
}

}  // namespace hc::internal
