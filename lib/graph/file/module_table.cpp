// SPDX-License-Identifier: Apache-2.0
// The table [modules.NAME], with its links.
#include <algorithm>
#include <cstdlib>

#include <graph/file/tables.h>
#include <hc/mtp/element.h>

namespace hc::internal {
namespace {

constexpr std::int64_t kMaxAddress = 2147483647;

class ModuleReader {
 public:
  ModuleReader(const Fields& fields, const std::string& name, Graph& graph)
      : fields_(fields), graph_(graph), module_(*graph.find(name)) {}

  void read(const Node& node) {
    auto encoding = [&](const Node& port) {
      fields_.choice({"text", "binary", "zstd", "jpeg"}, [&](const Node& value, std::size_t) {
        module_.encodings[port.key] = {*encoding_of(*value.as<std::string>()), value.place};
      })(port);
    };
    auto address = [&](const Node& port) {
      Lined<std::int64_t> number;
      fields_.integer(number, 0, kMaxAddress)(port);
      if (number.place.line != 0) module_.addresses[port.key] = number;
    };
    auto clock = [&](const Node& value, std::size_t) {
      module_.clock = {*value.as<std::string>(), value.place};
    };
    auto links = [&](bool to_input) {
      return fields_.each([this, to_input](const Node& port) {
        remove_links(port, to_input);
        add_links(port, to_input);
      });
    };
    std::vector<std::pair<const Node*, bool>> more;  // added last, in any order of the keys
    auto more_links = [&](bool to_input) {
      return [&more, to_input](const Node& ports) { more.emplace_back(&ports, to_input); };
    };
    fields_.read(node, "in module " + module_.name,
                 {{"program", fields_.text(module_.program)},
                  {"host", fields_.any_text(module_.host)},
                  {"parameters", fields_.each([&](const Node& value) { read_parameter(value); })},
                  {"inputs", links(true)},
                  {"outputs", links(false)},
                  {"more_inputs", more_links(true)},
                  {"more_outputs", more_links(false)},
                  {"addresses", fields_.each(address)},
                  {"encodings", fields_.each(encoding)},
                  {"to", fields_.each([&](const Node& value) { read_addressee(value); })},
                  {"clock", fields_.choice({"machine", "messages"}, clock)},
                  {"restart", read_restart(fields_, module_.restart)},
                  {"hang", fields_.integer(module_.hang, 0, kMaxSeconds)},
                  {"mode", fields_.text(module_.mode)},
                  {"modes", fields_.texts(module_.modes)},
                  {"exclusive", fields_.texts(module_.exclusive)},
                  {"ends_graph", fields_.flag(module_.ends_graph)}});
    for (const auto& [ports, to_input] : more)
      fields_.each([this, to = to_input](const Node& port) { add_links(port, to); })(*ports);
  }

 private:
  void read_parameter(const Node& value) {
    if (auto text = Fields::scalar(value))
      module_.parameters[value.key] = {*text, value.place};
    else
      fields_.add(value, "parameter \"{}\" must be a string, a number, true or false", value.key);
  }

  void read_addressee(const Node& value) {
    const auto* number = value.as<std::int64_t>();
    const auto* text = value.as<std::string>();
    if (number != nullptr && *number != 0 && std::abs(*number) <= kMaxAddress)
      module_.to[value.key] = {{{}, *number}, value.place};
    else if (text != nullptr && !text->empty())
      module_.to[value.key] = {{*text, 0}, value.place};
    else
      fields_.add(value, R"("{}" must be an address, an input or "all")", value.key);
  }

  /// Removes the links of an input, or those of an output to URIs.
  void remove_links(const Node& port, bool to_input) {
    const std::string ours = module_.name + "." + port.key;
    std::erase_if(graph_.links, [&](const GraphLink& link) {
      return to_input ? link.to.text() == ours : link.from.text() == ours && !link.to.uri.empty();
    });
  }

  void add_links(const Node& port, bool to_input) {
    if (!fields_.check_name(port, "port", port.key)) return;
    const GraphPort ours{module_.name, port.key, {}};
    Fields::one_or_more([&](const Node& value) {
      GraphLink link;
      (to_input ? link.to : link.from) = ours;
      link.place = value.place;
      const std::string other = to_input ? "from" : "to";
      if (value.table() == nullptr) return add_link(value, link, other, port.key);
      auto policy = [&](const Node& option) { read_policy(option, link); };
      std::vector<const Node*> ends;
      std::vector<Fields::Key> keys = {
          {other, Fields::one_or_more([&](const Node& end) { ends.push_back(&end); }), true},
          {"via", fields_.choice({"tls", "tcp", "dds"},
                                 [&](const Node& via, std::size_t) {
                                   link.via = {*via.as<std::string>(), via.place};
                                 })},
          {"route", [&](const Node& route) { read_route(route, link); }}};
      for (const auto key : kPolicyKeys) keys.push_back({std::string(key), policy});
      fields_.read(value, "in a link of " + ours.text(), keys);
      check_policy(link);
      for (const Node* end : ends) add_link(*end, link, other, other);
    })(port);
  }

  void add_link(const Node& end, GraphLink link, const std::string& other, const std::string& key) {
    const auto* text = end.as<std::string>();
    if (text == nullptr) return fields_.add(end, quoted_name(key) + " must be a string");
    auto port = parse_port(*text, true);
    if (!port) return fields_.add(end, port.error().detail);
    if (other == "to" && port->uri.empty())
      return fields_.add(end,
                         "\"{}\" is not a URI: an output's link to a module is declared there, as "
                         "inputs.PORT",
                         *text);
    (other == "from" ? link.from : link.to) = *port;
    graph_.links.push_back(std::move(link));
  }

  void read_policy(const Node& option, GraphLink& link) {
    std::string& text = link.policy[option.key].value;
    link.policy[option.key].place = option.place;
    const bool is_fraction = option.key == "scale" || option.key == "idle_rate";
    if (option.as<std::int64_t>() != nullptr || option.as<std::string>() != nullptr ||
        (is_fraction && option.as<double>() != nullptr))
      text = *Fields::scalar(option);
    if (text.empty())
      fields_.add(option, "\"{}\" must be a {} or a string", option.key,
                  is_fraction ? "number" : "whole number");
  }

  /// Problems: the first wrong option, whose value is cleared.
  void check_policy(GraphLink& link) {
    Uri policy;
    for (const auto key : kPolicyKeys) {
      auto option = link.policy.find(std::string(key));
      if (option == link.policy.end()) continue;
      if (option->second.value.empty()) return;
      policy.options.emplace_back(key, option->second.value);
      if (auto valid = hc::check_policy(policy); !valid) {
        Node at;
        at.place = option->second.place;
        option->second.value.clear();
        return fields_.add(at, valid.error().detail);
      }
    }
  }

  void read_route(const Node& node, GraphLink& link) {
    std::vector<std::int64_t> addresses;
    const auto* word = node.as<std::string>();
    bool is_right = node.list() != nullptr || (word != nullptr && *word == "all");
    link.routes_all = word != nullptr;
    for (const Node& each : node.nodes) {
      const auto* number = each.as<std::int64_t>();
      is_right = is_right && number != nullptr && std::abs(*number) <= kMaxAddress;
      if (number != nullptr) addresses.push_back(*number);
    }
    if (!is_right) fields_.add(node, R"("route" must be a list of addresses, or "all")");
    link.route = {std::move(addresses), node.place};
  }

  const Fields& fields_;
  Graph& graph_;
  GraphModule& module_;
};

}  // namespace

Fields::Take read_restart(const Fields& fields, Restart& to) {
  return fields.choice({"never", "failure", "always"},
                       [&to](const Node&, std::size_t word) { to = static_cast<Restart>(word); });
}

void read_module(const Fields& fields, const Node& node, const std::string& name, Graph& graph) {
  ModuleReader(fields, name, graph).read(node);
}

}  // namespace hc::internal
