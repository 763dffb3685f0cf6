// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which link of a router leads where. Pure. Internal to graph.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace hc::internal {

/// A link between two modules, which are numbers.
struct RoutedLink {
  std::size_t from = 0, to = 0;
  std::int64_t reaches = 0;  ///< the address of its input; 0: none
  /// What the graph file says that it passes; then nothing is computed.
  std::optional<std::vector<std::int64_t>> given;
};

/// The address of messages that are for all.
inline constexpr std::int64_t kAll = -1;

/// The number of a link's end that is no module.
inline constexpr std::size_t kOutside = static_cast<std::size_t>(-1);

struct Routes {
  /// The addresses that each link passes, in the order of numbers; none for links from modules that
  /// are no routers.
  std::vector<std::vector<std::int64_t>> passed;
  std::size_t longest = 0;  ///< the most routers that a message passes on its way to an address
};

/// An address is passed by one link of a router: the one that begins the way of the fewest hops to
/// it, of several the first. -1 (all) passes everywhere: routers see to it that such a message goes
/// round once.
///
/// @param is_router  by number of module.
/// Cost: the number of routers times that of links and addresses.
Routes compute_routes(const std::vector<RoutedLink>& links, const std::vector<bool>& is_router);

}  // namespace hc::internal
