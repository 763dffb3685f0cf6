// SPDX-License-Identifier: Apache-2.0
// Addresses of ports, and destinations of outputs.

#include <graph/plan/planning.h>
#include <graph/plan/routes.h>

namespace hc::internal {
namespace {

class Numbering {
 public:
  explicit Numbering(Planning& planning) : planning_(planning), graph_(planning.graph) {}

  void run() {
    for (const auto& module : graph_.modules) take_given(module);
    if (planning_.before != nullptr) keep_numbers(*planning_.before);
    for (const auto& module : graph_.modules) number_outputs(module);
    for (const auto& link : graph_.links)
      if (link.to.uri.empty() && planning_.routes(link.from)) address_of(link.to);
    for (const auto& module : graph_.modules)
      for (const auto& [port, to] : module.to) send_to(module, port, to);
    planning_.plan.addresses = inputs_;
  }

 private:
  /// Takes the addresses in the file; if an output and an input have the same name, the output's.
  void take_given(const GraphModule& module) {
    const Description* description = planning_.description_of(module.name);
    for (const auto& [port, address] : module.addresses) {
      if (address.value != 0 && !taken_.insert(address.value).second)
        planning_.problems.add(address.place, "address {} is used twice", address.value);
      if (description == nullptr) continue;
      if (find_named(description->outputs, port) != nullptr) continue;
      if (find_named(description->inputs, port) != nullptr) {
        if (address.value != 0) inputs_[module.name + "." + port] = address.value;
        continue;
      }
      auto ports = description->outputs;
      ports.insert(ports.end(), description->inputs.begin(), description->inputs.end());
      add_no_port(planning_, address.place, {module.name, port, {}}, "port", ports);
    }
  }

  /// Keeps earlier numbers, unless the file assigns them to other ports.
  void keep_numbers(const Plan& before) {
    auto keep = [&](const auto& numbers, auto& kept) {
      for (const auto& [port, number] : numbers)
        if (planning_.names.contains(port.substr(0, port.find('.'))) &&
            taken_.insert(number).second)
          kept[port] = number;
    };
    keep(before.sources, kept_outputs_);
    keep(before.addresses, kept_inputs_);
  }

  void number_outputs(const GraphModule& module) {
    PlannedModule* planned = planning_.planned(module.name);
    if (planned == nullptr) return;
    for (const auto& output : planning_.description_of(module.name)->outputs) {
      auto given = module.addresses.find(output.name);
      const std::string name = module.name + "." + output.name;
      std::int64_t address =
          given != module.addresses.end() ? given->second.value : free_address(kept_outputs_, name);
      planning_.plan.sources[name] = address;
      planned->add_option("--address", output.name + "=" + std::to_string(address));
    }
  }

  /// The earlier address of a port, or the lowest free one, which is then taken.
  std::int64_t free_address(const std::map<std::string, std::int64_t>& kept,
                            const std::string& port) {
    if (auto old = kept.find(port); old != kept.end()) return old->second;
    while (!taken_.insert(next_).second) ++next_;
    return next_;
  }

  /// The address of an input, assigned if it has none.
  std::int64_t address_of(const GraphPort& input) {
    auto [found, is_new] = inputs_.try_emplace(input.text(), 0);
    if (is_new) found->second = free_address(kept_inputs_, input.text());
    return found->second;
  }

  /// The input of that name; nullopt if there is none.
  std::optional<GraphPort> input_named(const std::string& name) const {
    auto dot = name.find('.');
    if (dot == std::string::npos) return std::nullopt;
    GraphPort port{name.substr(0, dot), name.substr(dot + 1), {}};
    const Description* description = planning_.description_of(port.module);
    // A module without a description, which has been reported, may have any input.
    bool may_be = description == nullptr ? planning_.names.contains(port.module)
                                         : find_named(description->inputs, port.port) != nullptr;
    return may_be ? std::optional(port) : std::nullopt;
  }

  [[nodiscard]] std::vector<std::string> names_of_inputs() const {
    std::vector<std::string> names;
    for (const auto& [module, description] : planning_.described)
      for (const auto& input : description.inputs) names.push_back(module + "." + input.name);
    return names;
  }

  void send_to(const GraphModule& module, const std::string& port, const Lined<Addressee>& to) {
    if (find_port(planning_, to.place, {module.name, port, {}}, false) == nullptr) return;
    std::optional<std::int64_t> address;
    const std::string& name = to.value.name;
    if (name.empty()) address = to.value.number;
    if (name == "all") address = kAll;
    if (auto input = input_named(name)) address = address_of(*input);
    if (!address) {
      auto known = names_of_inputs();
      known.emplace_back("all");
      return planning_.problems.add(to.place, "no input \"{}\"{}", name,
                                    suggest(planning_, name, known));
    }
    planning_.planned(module.name)->add_option("--to", port + "=" + std::to_string(*address));
  }

  Planning& planning_;
  const Graph& graph_;
  std::set<std::int64_t> taken_;
  std::int64_t next_ = 1;
  std::map<std::string, std::int64_t> inputs_, kept_outputs_, kept_inputs_;
};

}  // namespace

void number_ports(Planning& planning) {
  Numbering(planning).run();
}

/// A number must be the address of an input, or pass a link to the outside.
void check_destinations(Planning& planning) {
  if (!planning.problems.empty()) return;
  std::set<std::int64_t> known;
  for (const auto& [input, address] : planning.plan.addresses) known.insert(address);
  for (const auto& link : planning.graph.links) {
    const std::string& outside = link.from.uri + link.to.uri;
    if (link.routes_all || !(outside.empty() || outside.starts_with("file:"))) return;
    if (link.route) known.insert(link.route->value.begin(), link.route->value.end());
  }
  for (const auto& module : planning.graph.modules)
    for (const auto& [port, to] : module.to)
      if (to.value.name.empty() && to.value.number > 0 && !known.contains(to.value.number))
        planning.problems.add(to.place, "no input has the address {}", to.value.number);
}

}  // namespace hc::internal
