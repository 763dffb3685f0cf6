// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/plan.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include <hc/base/parameter.h>
#include <hc/base/suggestion.h>
#include <hc/link/transports.h>

namespace hc {
namespace {

using Json = nlohmann::json;

/// Whether links outlive the processes at their ends. Neither the runner nor modules can do that
/// yet, so every link is one that ends with them.
constexpr bool kLinksLast = false;

/// Longest name of a link: a socket's has 107 bytes, of which shared memory takes 17.
constexpr std::size_t kMaxLinkName = 90;

/// 64 bits of a text, as 16 hexadecimal digits. Source: FNV-1a,
/// https://datatracker.ietf.org/doc/html/draft-eastlake-fnv
std::string digest(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[hash >> shift & 15];
  return digits;
}

std::vector<std::string> names_of(const Json& list) {
  std::vector<std::string> names;
  for (const auto& each : list) names.push_back(each.at("name"));
  return names;
}

const Json* find_named(const Json& list, const std::string& name) {
  for (const auto& each : list)
    if (each.at("name") == name) return &each;
  return nullptr;
}

/// Whether a program has said of itself what is needed of it here.
bool is_description(const Json& json) {
  auto all = [](const Json& list, auto is_right) {
    return list.is_array() && std::all_of(list.begin(), list.end(), is_right);
  };
  auto has = [](const Json& object, const char* key, auto is_right) {
    return object.is_object() && object.contains(key) && is_right(object[key]);
  };
  auto is_text = [](const Json& value) { return value.is_string(); };
  auto is_number = [](const Json& value) { return value.is_number(); };
  auto is_type = [&](const Json& type) {
    return has(type, "type", is_text) && has(type, "scalar", is_text) &&
           has(type, "components", is_number) && has(type, "width", is_number) &&
           has(type, "height", is_number) && has(type, "coord", is_number);
  };
  auto is_port = [&](const Json& port) {
    return has(port, "name", is_text) &&
           has(port, "types", [&](const Json& types) { return all(types, is_type); });
  };
  auto is_output = [&](const Json& port) { return is_port(port) && !port["types"].empty(); };
  auto is_parameter = [&](const Json& parameter) {
    auto fits = [&](const char* key, auto is_right) {
      return !parameter.contains(key) || is_right(parameter[key]);
    };
    return has(parameter, "name", is_text) && has(parameter, "type", is_text) &&
           fits("least", is_number) && fits("most", is_number) &&
           fits("choices", [&](const Json& list) { return all(list, is_text); });
  };
  return has(json, "inputs", [&](const Json& list) { return all(list, is_port); }) &&
         has(json, "outputs", [&](const Json& list) { return all(list, is_output); }) &&
         has(json, "parameters", [&](const Json& list) { return all(list, is_parameter); });
}

/// Whether what one port gives is what another takes; 0 and an empty list fit everything.
bool type_fits(const Json& given, const Json& taken) {
  for (const char* key : {"type", "components", "scalar"})
    if (given.at(key) != taken.at(key)) return false;
  for (const char* key : {"width", "height", "coord"})
    if (given.at(key) != 0 && taken.at(key) != 0 && given.at(key) != taken.at(key)) return false;
  return true;
}

/// What an output gives, were it encoded so. A type that is not known here is of no matrix type.
Info info_from(const Json& type, Encoding encoding) {
  return {matrix_type_of(type.at("type").get<std::string>()).value_or(MatrixType{}),
          type.at("components").get<std::uint8_t>(),
          scalar_of(type.at("scalar").get<std::string>()).value_or(Scalar::F64), encoding};
}

/// A parameter as its module declared it, to try values on.
ParameterState parameter_from(const Json& json) {
  ParameterState parameter;
  parameter.name = json.at("name");
  std::string type = json.at("type");
  if (type == "bool") parameter.value = false;
  if (type == "integer") parameter.value = std::int64_t{0};
  if (type == "number") parameter.value = 0.0;
  if (type == "string") parameter.value = std::string();
  parameter.options.least = json.value("least", parameter.options.least);
  parameter.options.most = json.value("most", parameter.options.most);
  parameter.options.choices = json.value("choices", parameter.options.choices);
  return parameter;
}

std::string in_words(const Json& types) {
  std::string text;
  for (const auto& type : types) {
    if (!text.empty()) text += " or ";
    text += type.at("type").get<std::string>() + " " + type.at("components").dump() + " x " +
            type.at("scalar").get<std::string>();
    if (type.at("coord") != 0) text += " in coordinate system " + type.at("coord").dump();
  }
  return text;
}

class Planner {
 public:
  Planner(Graph graph, const Describe& describe, std::string_view token, Problems& problems)
      : graph_(std::move(graph)), describe_(describe), problems_(problems) {
    plan_.token = token;
  }

  Plan plan() {
    for (const auto& module : graph_.modules)
      for (const auto& [port, address] : module.addresses)
        if (address.value != 0 && !addresses_.insert(address.value).second)
          problems_.add(address.line,
                        "address " + std::to_string(address.value) + " is given twice");
    for (const auto& module : graph_.modules) plan_module(module);
    for (const auto& link : graph_.links) check_link(link);
    check_loops();
    if (problems_.empty()) add_links();
    return std::move(plan_);
  }

 private:
  void plan_module(const GraphModule& module) {
    if (module.program.empty()) return;
    auto describe = [&]() -> std::optional<Json> {
      auto text = describe_(module.program);
      if (!text) {
        problems_.add(module.line, "module " + module.name + ": " + text.error().detail);
        return std::nullopt;
      }
      Json description = Json::parse(*text, nullptr, false);
      if (is_description(description)) return description;
      problems_.add(module.line, "module " + module.name + ": " + module.program +
                                     " --describe prints no description of a module");
      return std::nullopt;
    };
    auto described = describe();
    if (!described) return;
    Json& description = *described;
    PlannedModule planned;
    planned.name = module.name;
    planned.program = module.program;
    planned.options = {"--name", module.name};
    auto add = [&](std::string option, std::string value) {
      planned.options.push_back(std::move(option));
      planned.options.push_back(std::move(value));
    };
    for (const auto& [name, value] : module.parameters) {
      const Json* parameter = find_named(description["parameters"], name);
      if (parameter == nullptr) {
        problems_.add(value.line, "module " + module.name + " has no parameter \"" + name + "\"" +
                                      suggestion(name, names_of(description["parameters"])));
        continue;
      }
      if (auto set = parameter_from(*parameter).set(value.value); !set)
        problems_.add(value.line, "module " + module.name + ": " + set.error().detail);
      planned.parameters[name] = value.value;
    }
    const Json& outputs = description["outputs"];
    for (const auto& [port, address] : module.addresses)
      if (find_named(outputs, port) == nullptr)
        add_no_port(module.name, address.line, "output", port, outputs);
    for (const auto& port : names_of(outputs)) {
      auto given = module.addresses.find(port);
      add("--address", port + "=" +
                           std::to_string(given != module.addresses.end() ? given->second.value
                                                                          : free_address()));
    }
    for (const auto& [port, encoding] : module.encodings) {
      const Json* output = find_named(outputs, port);
      if (output == nullptr) {
        add_no_port(module.name, encoding.line, "output", port, outputs);
        continue;
      }
      if (auto broken = find_error(info_from(output->at("types").at(0), encoding.value)))
        problems_.add(encoding.line, "module " + module.name + ": R" +
                                         std::to_string(broken->rule) + " " + port + ": " +
                                         broken->what);
      add("--encoding", port + "=" + std::string(name(encoding.value)));
    }
    planned.manage_uri = "unix-listen:@" + link_name({module.name, "manage"});
    index_[module.name] = plan_.modules.size();
    plan_.modules.push_back(std::move(planned));
    described_[module.name] = std::move(description);
  }

  /// The least address that nobody has, taken.
  std::int64_t free_address() {
    while (!addresses_.insert(next_address_).second) ++next_address_;
    return next_address_;
  }

  void add_no_port(const std::string& module, int line, const std::string& kind,
                   const std::string& port, const Json& ports) const {
    problems_.add(line, "module " + module + " has no " + kind + " \"" + port + "\"" +
                            suggestion(port, names_of(ports)));
  }

  /// Null where there is none, or where nobody knows since the module is not described.
  const Json* find_port(const GraphPort& port, int line, const char* list,
                        const std::string& kind) {
    if (graph_.find(port.module) == nullptr) {
      std::vector<std::string> known;
      for (const auto& module : graph_.modules) known.push_back(module.name);
      problems_.add(line, "no module \"" + port.module + "\"" + suggestion(port.module, known));
    }
    auto found = described_.find(port.module);
    if (found == described_.end()) return nullptr;
    const Json& ports = found->second.at(list);
    const Json* json = find_named(ports, port.port);
    if (json == nullptr) add_no_port(port.module, line, kind, port.port, ports);
    return json;
  }

  void check_link(const GraphLink& link) {
    if (!linked_.insert(link.from.text() + " " + link.to.text()).second)
      problems_.add(link.line, "the link from " + link.from.text() + " to " + link.to.text() +
                                   " is there twice");
    const Json* from = find_port(link.from, link.line, "outputs", "output");
    const Json* to = find_port(link.to, link.line, "inputs", "input");
    if (from == nullptr || to == nullptr) return;
    const Json& taken = to->at("types");
    const Json& given = from->at("types").at(0);
    if (!taken.empty() && std::none_of(taken.begin(), taken.end(),
                                       [&](const Json& type) { return type_fits(given, type); }))
      problems_.add(link.line, link.from.text() + " gives " + in_words(from->at("types")) + ", " +
                                   link.to.text() + " takes " + in_words(taken));
    if (auto memory = link.policy.find("memory"); memory != link.policy.end() && shared(link)) {
      auto enough = internal::check_shm_memory({"shm", "", {{"memory", memory->second.value}}});
      if (!enough) problems_.add(memory->second.line, enough.error().detail);
    }
  }

  /// A message that comes back to where it came from, and makes another, does so as fast as the
  /// machine can, unless a link on its way has a rate.
  void check_loops() const {
    std::map<std::string, std::vector<const GraphLink*>> leaving;
    for (const auto& link : graph_.links)
      if (!link.policy.contains("rate") && !link.policy.contains("byte_rate"))
        leaving[link.from.module].push_back(&link);
    enum class Visit { Begun = 1, Done };
    std::map<std::string, Visit> visits;
    std::vector<const GraphLink*> way;
    // Depth first, without recursion: each step of the way, and which of its links is next.
    for (const auto& module : graph_.modules) {
      if (visits.contains(module.name)) continue;
      std::vector<std::pair<std::string, std::size_t>> steps = {{module.name, 0}};
      visits[module.name] = Visit::Begun;
      while (!steps.empty()) {
        auto& [name, next] = steps.back();
        const auto& links = leaving[name];
        if (next == links.size()) {
          visits[name] = Visit::Done;
          steps.pop_back();
          if (!way.empty()) way.pop_back();
          continue;
        }
        const GraphLink* link = links[next++];
        auto visit = visits.find(link->to.module);
        if (visit == visits.end()) {
          visits[link->to.module] = Visit::Begun;
          way.push_back(link);
          steps.emplace_back(link->to.module, 0);
        } else if (visit->second == Visit::Begun) {
          add_loop(way, *link);
        }
      }
    }
  }

  void add_loop(const std::vector<const GraphLink*>& way, const GraphLink& last) const {
    std::string text = last.to.module;
    auto begin = std::find_if(way.begin(), way.end(), [&](const GraphLink* link) {
      return link->from.module == last.to.module;
    });
    for (auto link = begin; link != way.end(); ++link) text += " -> " + (*link)->to.module;
    problems_.add(last.line, "a loop without a rate: " + text + " -> " + last.to.module +
                                 "; give one of its links a rate, as rate = 30");
  }

  /// Whether a module can be linked by shared memory; what is no program of ours may know only
  /// streams.
  bool shares_memory(const std::string& module) const {
    const Json& description = described_.at(module);
    if (!description.contains("transports")) return false;
    const Json& known = description["transports"];  // whatever it is, one may look for it there
    return std::find(known.begin(), known.end(), "shm") != known.end();
  }

  bool shared(const GraphLink& link) const {
    return shares_memory(link.from.module) && shares_memory(link.to.module);
  }

  /// Images are as good as they are new, so that the newest alone waits for who is slow; of
  /// anything else all.
  std::string keep_of(const GraphLink& link) const {
    if (auto given = link.policy.find("keep"); given != link.policy.end())
      return given->second.value;
    const Json* output = find_named(described_.at(link.from.module)["outputs"], link.from.port);
    const std::string type = output->at("types").at(0).at("type");
    return type == name(MatrixType::RgbImage) || type == name(MatrixType::IntensityImage) ? "latest"
                                                                                          : "all";
  }

  /// What one link of an output says to its sender, as options of a URI; `keep` is the reader's
  /// affair where memory is shared.
  static std::string pace_of(const GraphLink& link) {
    std::string options;
    for (const auto& [key, value] : link.policy)
      if (key != "keep") options.append("&").append(key).append("=").append(value.value);
    return options;
  }

  /// A link's name: the same in every plan of this graph, and no other's.
  [[nodiscard]] std::string link_name(std::initializer_list<std::string> words) const {
    std::string name = plan_.token;
    for (const auto& word : words) name += "." + word;
    if (name.size() <= kMaxLinkName) return name;
    return plan_.token + "." + digest(name);
  }

  /// Whether a link outlives the processes at its ends.
  [[nodiscard]] bool lasts(const GraphLink& link) const {
    auto is_restarted = [&](const std::string& module) {
      return plan_.modules[index_.at(module)].restart != Restart::Never;
    };
    return kLinksLast && (is_restarted(link.from.module) || is_restarted(link.to.module));
  }

  /// Gives each link its two ends. The links of an output that share memory have one sending end in
  /// common, but for those that have a pace or bound of their own; every other link has a socket.
  /// Senders wait for their readers, so that it does not matter who starts first.
  void add_links() {
    struct Sender {
      std::size_t readers = 0;
      bool lasts = false;
      std::string uri;
    };
    std::map<std::string, Sender> senders;  // by name
    auto name_of = [&](const GraphLink& link) {
      bool own = !pace_of(link).empty() || !shared(link);
      return own ? link_name({link.from.module, link.from.port, link.to.module, link.to.port})
                 : link_name({link.from.module, link.from.port});
    };
    for (const auto& link : graph_.links) {
      Sender& sender = senders[name_of(link)];
      ++sender.readers;
      sender.lasts = sender.lasts || lasts(link);
    }
    for (const auto& link : graph_.links) {
      auto& from = plan_.modules[index_[link.from.module]];
      auto& to = plan_.modules[index_[link.to.module]];
      bool by_memory = shared(link);
      const std::string name = name_of(link), keep = keep_of(link);
      const std::string and_keep = keep == "all" ? "" : "&keep=" + keep;
      Sender& sender = senders[name];
      if (sender.uri.empty()) {
        bool shares_keep = by_memory && pace_of(link).empty();
        sender.uri = (by_memory ? "shm:" : "unix-listen:@") + name +
                     "?readers=" + std::to_string(sender.readers) +
                     (sender.lasts ? "&stay=1" : "") + (shares_keep ? "" : and_keep) +
                     pace_of(link);
        from.ends.push_back({false, link.from.port, sender.uri, {}});
      }
      const std::string reader_uri = (by_memory ? "shm:" : "unix:@") + name +
                                     (sender.lasts ? "?reconnect=86400" : "?wait=60") +
                                     (by_memory ? and_keep : "");
      to.ends.push_back({true, link.to.port, reader_uri, {}});
      PlannedLink planned{link.from.text(), link.to.text(), sender.uri, reader_uri, keep, {},
                          sender.lasts};
      for (const auto& [key, value] : link.policy)
        if (key != "keep") planned.policy[key] = value.value;
      plan_.links.push_back(std::move(planned));
    }
  }

  Graph graph_;
  const Describe& describe_;
  Problems& problems_;
  Plan plan_;
  std::map<std::string, Json> described_;  // what the programs of modules say of themselves
  std::map<std::string, std::size_t> index_;
  std::set<std::int64_t> addresses_;
  std::int64_t next_address_ = 1;
  std::set<std::string> linked_;
};

}  // namespace

std::vector<std::string> PlannedModule::command() const {
  std::vector<std::string> words = {program};
  words.insert(words.end(), options.begin(), options.end());
  for (const auto& [key, value] : parameters) words.push_back("--" + key + "=" + value);
  auto add = [&](const char* option, std::string value) {
    words.emplace_back(option);
    words.push_back(std::move(value));
  };
  auto peer_of = [](std::string_view listening) {
    listening = listening.substr(0, listening.find('?'));
    return "unix" + std::string(listening.substr(listening.find(':'))) + "?wait=10";
  };
  if (!manage_uri.empty()) add("--manage", peer_of(manage_uri));
  if (!control_uri.empty()) add("--control", peer_of(control_uri));
  for (const auto& end : ends) add(end.is_input ? "--in" : "--out", end.port + "=" + end.uri);
  for (const auto& end : ends)
    if (!end.route.empty()) add("--route", end.port + "=" + end.uri + " " + end.route);
  return words;
}

Plan make_plan(Graph graph, const Describe& describe, std::string_view token, Problems& problems) {
  return Planner(std::move(graph), describe, token, problems).plan();
}

}  // namespace hc
