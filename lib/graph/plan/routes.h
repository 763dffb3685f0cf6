// SPDX-License-Identifier: Apache-2.0
#pragma once
// Computes the routing tables of a graph's routers. Pure. Internal to graph.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace hc::internal {

/// A link between two modules, given by their indices.
struct RoutedLink {
  std::size_t from = 0, to = 0;
  std::int64_t reaches = 0;  ///< the address of its input; 0: none
  /// The addresses that it passes according to the graph file; nullopt: computed.
  std::optional<std::vector<std::int64_t>> given;
};

/// The broadcast address.
inline constexpr std::int64_t kAll = -1;

/// The index of an end outside the graph.
inline constexpr std::size_t kOutside = static_cast<std::size_t>(-1);

struct Routes {
  /// The addresses that each link passes, sorted; none if it does not leave a router.
  std::vector<std::vector<std::int64_t>> passed;
  std::size_t longest = 0;  ///< most routers on the path to any address
};

/// Each router passes an address to one link: the first one on a path with the fewest hops. All
/// links pass -1 (all); routers do not forward such a message twice.
///
/// @param is_router  by index of module.
/// Cost: number of routers times number of links and addresses.
Routes compute_routes(const std::vector<RoutedLink>& links, const std::vector<bool>& is_router);

}  // namespace hc::internal
