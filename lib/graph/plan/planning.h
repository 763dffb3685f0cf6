// SPDX-License-Identifier: Apache-2.0
#pragma once
// The steps from a graph to a plan, in the order of make_plan(). Internal to graph.

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <graph/plan.h>
#include <hc/contract/description.h>

namespace hc::internal {

/// The state of planning.
struct Planning {
  Graph graph;  ///< after check_links() with valid links only, as far as modules are described
  Problems& problems;
  const Plan* before;  ///< an earlier plan whose numbers stay; null: none
  const HoldPort& hold_port;
  const HostPlaces& places;
  Plan plan{};
  std::map<std::string, Description> described{};  ///< by module
  std::map<std::string, std::size_t> index{};      ///< into Plan::modules, by module
  std::set<std::string> names{};                   ///< of modules

  /// A module's description; null if unknown.
  [[nodiscard]] const Description* description_of(const std::string& module) const {
    auto found = described.find(module);
    return found == described.end() ? nullptr : &found->second;
  }
  [[nodiscard]] bool is_router(const std::string& module) const {
    const Description* description = description_of(module);
    return description != nullptr && description->routes;
  }
  /// Whether an output routes messages by address: an output of any type, of a router.
  [[nodiscard]] bool routes(const GraphPort& output) const {
    if (!output.uri.empty() || !is_router(output.module)) return false;
    const PortDescription* port = find_named(described.at(output.module).outputs, output.port);
    return port != nullptr && port->types.empty();
  }
  [[nodiscard]] bool is_linked(const GraphPort& input) const {
    return std::any_of(graph.links.begin(), graph.links.end(),
                       [&](const auto& link) { return link.to.text() == input.text(); });
  }
  [[nodiscard]] bool is_read(const GraphPort& output) const {
    return std::any_of(graph.links.begin(), graph.links.end(),
                       [&](const auto& link) { return link.from.text() == output.text(); });
  }
  [[nodiscard]] const std::string& host_of(const std::string& module) const {
    return plan.modules[index.at(module)].host;
  }
  /// Whether a link between two modules goes from one host to another.
  [[nodiscard]] bool is_between_hosts(const GraphLink& link) const {
    return host_of(link.from.module) != host_of(link.to.module);
  }
  [[nodiscard]] PlannedModule* planned(const std::string& module) {
    auto found = index.find(module);
    return found == index.end() ? nullptr : &plan.modules[found->second];
  }
};

/// Problem of a module {} with a key {} that requires --control.
inline constexpr std::string_view kNeedsControl =
    "module {} cannot have \"{}\": its program does not support --control; see spec/module.md, "
    "sections 3 and 6";

/// Whether a program has a string parameter of that name.
bool has_text_parameter(const Description& description, std::string_view name);

/// `, did you mean "camera"?`; empty when there are already many problems.
std::string suggest(const Planning& planning, std::string_view name,
                    const std::vector<std::string>& known);

/// Problem: a module has no such port. @param kind  "input", "output" or "port".
void add_no_port(Planning& planning, const Place& place, const GraphPort& port,
                 const std::string& kind, const std::vector<PortDescription>& ports);

/// A port named in the file, or the implicit input `focus`. Null if the module is not described, or
/// lacks the port, which is a problem.
const PortDescription* find_port(Planning& planning, const Place& place, const GraphPort& port,
                                 bool is_input);

/// Assigns addresses to ports, and destinations to outputs.
void number_ports(Planning& planning);

/// Checks modes and exclusive inputs, passes them to modules, and links the focus.
void plan_modes(Planning& planning);

/// Whether a module has a text parameter `frames`.
bool takes_frames(const Planning& planning, const std::string& module);
/// Links outputs that move frames to the inputs `frames` of modules that take frames.
void link_frames(Planning& planning);
/// Checks the frames and passes them to modules that take frames.
void plan_frames(Planning& planning);

/// Checks each link on its own and removes wrong ones from the graph.
void check_links(Planning& planning);
/// Problems: loops without a rate.
void check_loops(Planning& planning);
/// Problems: actors with several writers.
void check_actors(Planning& planning);
/// Problems: synchronised inputs of which only some are linked.
void check_together(Planning& planning);
/// Problems: modes that can never get the focus.
void check_bids(Planning& planning);
/// Problems: unknown destination addresses.
void check_destinations(Planning& planning);

/// A transport and the URI schemes of its ends.
struct LinkTransport {
  std::string_view name, writer, reader;
};

/// The transport of a link between two described modules: on one host the first of shm, unix and
/// tcp that both support; between hosts `via`, by default tls. Null if there is none.
const LinkTransport* transport_of(const Planning& planning, const GraphLink& link);

/// Gives each link its two ends.
void plan_links(Planning& planning);

/// Warns of links and loops that may move a robot badly; call this after plan_links().
void check_motion(Planning& planning);

}  // namespace hc::internal
