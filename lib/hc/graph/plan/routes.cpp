// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/plan/routes.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

namespace hc::internal {
namespace {

class Routes {
 public:
  Routes(const std::vector<RoutedLink>& links, const std::vector<bool>& is_router)
      : links_(links), is_router_(is_router), leaving_(is_router.size()) {
    for (std::size_t i = 0; i < links.size(); ++i)
      if (is_router_at(links[i].from)) leaving_[links[i].from].push_back(i);
  }

  [[nodiscard]] bool is_router_at(std::size_t module) const {
    return module < is_router_.size() && is_router_[module];
  }

  /// By address, the link of a router that begins the shortest way there.
  [[nodiscard]] std::map<std::int64_t, std::size_t> first_links(std::size_t router) const {
    std::map<std::int64_t, std::size_t> first;
    std::map<std::size_t, std::size_t> begun_by;  // the link by which a router is reached
    std::deque<std::size_t> next = {router};      // breadth first: the nearest come first
    for (; !next.empty(); next.pop_front())
      for (std::size_t i : leaving_[next.front()]) {
        const RoutedLink& link = links_[i];
        std::size_t begin = next.front() == router ? i : begun_by.at(next.front());
        for (std::int64_t address : link.given ? *link.given : std::vector{link.reaches})
          if (address > 0) first.emplace(address, begin);
        if (is_router_at(link.to) && link.to != router && begun_by.emplace(link.to, begin).second)
          next.push_back(link.to);
      }
    return first;
  }

  /// By address, how many routers are passed from this one on.
  [[nodiscard]] std::map<std::int64_t, std::size_t> hops(std::size_t router) const {
    std::map<std::int64_t, std::size_t> hops;
    std::map<std::size_t, std::size_t> distance = {{router, 1}};
    std::deque<std::size_t> next = {router};
    for (; !next.empty(); next.pop_front())
      for (std::size_t i : leaving_[next.front()]) {
        const RoutedLink& link = links_[i];
        const std::size_t passed = distance.at(next.front());
        if (link.reaches > 0) hops.emplace(link.reaches, passed);
        if (is_router_at(link.to) && distance.emplace(link.to, passed + 1).second)
          next.push_back(link.to);
      }
    return hops;
  }

 private:
  const std::vector<RoutedLink>& links_;
  const std::vector<bool>& is_router_;
  std::vector<std::vector<std::size_t>> leaving_;  // by router, the links that leave it
};

}  // namespace

std::size_t longest_way(const std::vector<RoutedLink>& links, const std::vector<bool>& is_router) {
  const Routes routes(links, is_router);
  std::size_t longest = 0;
  for (std::size_t router = 0; router < is_router.size(); ++router)
    if (is_router[router])
      for (const auto& [address, hops] : routes.hops(router)) longest = std::max(longest, hops);
  return longest;
}

std::vector<std::vector<std::int64_t>> compute_routes(const std::vector<RoutedLink>& links,
                                                      const std::vector<bool>& is_router) {
  const Routes routes(links, is_router);
  std::vector<std::set<std::int64_t>> passed(links.size());
  for (std::size_t router = 0; router < is_router.size(); ++router)
    if (is_router[router])
      for (const auto& [address, link] : routes.first_links(router)) passed[link].insert(address);
  std::vector<std::vector<std::int64_t>> all;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const RoutedLink& link = links[i];
    if (!routes.is_router_at(link.from)) {
      all.emplace_back();
      continue;
    }
    if (link.given) {
      all.push_back(*link.given);
      continue;
    }
    passed[i].insert(kAll);
    all.emplace_back(passed[i].begin(), passed[i].end());
  }
  return all;
}

}  // namespace hc::internal
