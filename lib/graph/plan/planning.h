// SPDX-License-Identifier: Apache-2.0
#pragma once
// The steps from a graph to a plan; plan.cpp takes them one after the other. Internal to graph.

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <graph/plan.h>
#include <hc/contract/description.h>

namespace hc::internal {

/// What is known while one plans.
struct Planning {
  Graph graph;  ///< its links have modules, ports and types that fit, as far as they are described
  Problems& problems;
  const Plan* before;  ///< of this graph, whose numbers stay; null: there was none
  const HoldPort& hold_port;
  const HostPlaces& places;
  Plan plan{};
  std::map<std::string, Description> described{};  ///< by module
  std::map<std::string, std::size_t> index{};      ///< of a module in Plan::modules
  std::set<std::string> names{};                   ///< of modules

  /// What a module says of itself; null where nobody knows.
  [[nodiscard]] const Description* description_of(const std::string& module) const {
    auto found = described.find(module);
    return found == described.end() ? nullptr : &found->second;
  }
  [[nodiscard]] bool is_router(const std::string& module) const {
    const Description* description = description_of(module);
    return description != nullptr && description->routes;
  }
  /// Whether messages leave an output by their address: of a router, one that gives anything.
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
  /// Where a module runs.
  [[nodiscard]] const std::string& host_of(const std::string& module) const {
    return plan.modules[index.at(module)].host;
  }
  /// Whether a link, whose ends are both modules, goes from one host to another.
  [[nodiscard]] bool is_between_hosts(const GraphLink& link) const {
    return host_of(link.from.module) != host_of(link.to.module);
  }
  [[nodiscard]] PlannedModule* planned(const std::string& module) {
    auto found = index.find(module);
    return found == index.end() ? nullptr : &plan.modules[found->second];
  }
};

/// What is wrong with a module, {}, that has a key, {}, for which its program is too simple.
inline constexpr std::string_view kNeedsControl =
    "module {} cannot have \"{}\": its program does not support --control; see spec/module.md, "
    "sections 3 and 6";

/// Whether a program has a parameter of that name that is a string.
bool has_text_parameter(const Description& description, std::string_view name);

/// ", did you mean "camera"?", unless too much is wrong to look for it all.
std::string suggest(const Planning& planning, std::string_view name,
                    const std::vector<std::string>& known);

/// Says that a module has no such port. @param kind  "input", "output" or "port".
void add_no_port(Planning& planning, const Place& place, const GraphPort& port,
                 const std::string& kind, const std::vector<PortDescription>& ports);

/// A port that the file names, with the implicit input `focus`; null where there is none, which is
/// a problem, or where nobody knows since the module is not described.
const PortDescription* find_port(Planning& planning, const Place& place, const GraphPort& port,
                                 bool is_input);

/// Gives ports their addresses, and messages of outputs their destinations.
void number_ports(Planning& planning);

/// Modes, focus and exclusive inputs: checks them, hands them to modules, and links the focus to
/// them.
void plan_modes(Planning& planning);

/// Whether a module gets the frames as text: it has a parameter for them.
bool takes_frames(const Planning& planning, const std::string& module);
/// Links what moves frames to the inputs `frames` of modules that get them as text.
void link_frames(Planning& planning);
/// Checks the frames, and hands them to modules that have a parameter `frames`.
void plan_frames(Planning& planning);

/// Checks each link on its own; those that are wrong are taken out of the graph.
void check_links(Planning& planning);
/// Loops without a rate, and actors that several command.
void check_loops(Planning& planning);
void check_actors(Planning& planning);
/// Inputs that are taken together and not all linked, modes that can never have the focus,
/// destinations that nobody has.
void check_together(Planning& planning);
void check_bids(Planning& planning);
void check_destinations(Planning& planning);

/// What links go over, and the schemes of their ends.
struct LinkTransport {
  std::string_view name, writer, reader;
};

/// What a link between two modules goes over, the first of shm, unix and tcp that both have, or tls
/// (or tcp or dds, if that is asked for) to another host; null where there is none. Both are
/// described.
const LinkTransport* transport_of(const Planning& planning, const GraphLink& link);

/// Gives each link its two ends.
void plan_links(Planning& planning);

/// Warns of links and loops by which a robot may come to harm; behind plan_links().
void check_motion(Planning& planning);

}  // namespace hc::internal
