// SPDX-License-Identifier: Apache-2.0
// Checks of single links, and of links together.
#include <algorithm>
#include <map>

#include <graph/plan/planning.h>
#include <hc/base/format.h>
#include <hc/base/place_word.h>
#include <hc/base/uri.h>
#include <hc/contract/conversion.h>
#include <hc/link/link.h>
#include <hc/link/transports.h>

namespace hc::internal {
namespace {

/// Checks links one by one; call check() once for each, in their order.
class LinkCheck {
 public:
  explicit LinkCheck(Planning& planning) : planning_(planning), problems_(planning.problems) {}

  /// Returns whether the link is valid.
  bool check(const GraphLink& link) {
    if (!linked_.insert(link.from.text() + " " + link.to.text()).second) {
      problems_.add(link.place, "duplicate link from {} to {}", link.from.text(), link.to.text());
      return false;
    }
    const PortDescription* from = end(link, link.from, false);
    const PortDescription* to = end(link, link.to, true);
    if (link.route) check_route(link);
    if (!link.from.uri.empty() || !link.to.uri.empty()) check_outer_policy(link);
    if (from != nullptr && to == nullptr) check_conversion(link, from->types, {});
    if (from == nullptr || to == nullptr) return true;
    bool right = fits(from->types, to->types);
    if (!right)
      problems_.add(link.place, "{} sends {}, {} takes {}", link.from.text(), in_words(from->types),
                    link.to.text(), in_words(to->types));
    if (!link.via.value.empty() && !planning_.is_between_hosts(link))
      problems_.add(link.via.place,
                    "\"via\" is for a link between hosts, and {} and {} run on the same",
                    link.from.module, link.to.module);
    const auto* transport = transport_of(planning_, link);
    if (transport == nullptr) {
      right = false;
      add_no_transport(link);
    }
    if (auto memory = link.policy.find("memory"); memory != link.policy.end() &&
                                                  !memory->second.value.empty() &&
                                                  transport != nullptr && transport->name == "shm")
      if (auto enough = check_shm_memory({"shm", "", {{"memory", memory->second.value}}}); !enough)
        problems_.add(memory->second.place, enough.error().detail);
    check_conversion(link, from->types, to->types);
    return right;
  }

 private:
  /// The schemes of links to and from URIs.
  static std::vector<std::string> schemes_of(const Description& description) {
    std::vector<std::string> schemes = {"file", "tcp", "tcp-listen", "unix", "unix-listen"};
    if (description.transports) schemes = *description.transports;
    std::erase_if(schemes, [](const auto& each) { return each == "-" || each == "inproc"; });
    return schemes;
  }

  void add_no_transport(const GraphLink& link) {
    auto supported = [this](const std::string& module) {
      const auto list = joined(schemes_of(*planning_.description_of(module)), ", ");
      return "module " + module + " supports " + (list.empty() ? "none" : list);
    };
    const std::string &from = link.from.module, &to = link.to.module, &via = link.via.value;
    std::string takes;
    if (!planning_.is_between_hosts(link))
      takes = hc::format(
          "shm at both ends, or tcp-listen at {} and tcp at {}, or unix-listen and unix", from, to);
    else if (via == "dds")
      takes = "dds at both ends";
    else if (via == "tcp")
      takes = hc::format("tcp-listen at {} and tcp at {}", from, to);
    else
      takes = hc::format(
          "tls-listen at {} and tls at {}; via = \"tcp\" would be neither encrypted "
          "nor authenticated",
          from, to);
    problems_.add(link.place, "no transport from {} to {}: {}, {}; it takes {}", link.from.text(),
                  link.to.text(), supported(from), supported(to), takes);
  }

  /// The port; null for a URI, a missing port, or a module that is not described.
  const PortDescription* end(const GraphLink& link, const GraphPort& port, bool is_input) {
    if (!port.uri.empty()) {
      check_uri(link, port, is_input);
      return nullptr;
    }
    return find_port(planning_, link.place, port, is_input);
  }

  /// Checks an end outside the graph; the other end is a module.
  void check_uri(const GraphLink& link, const GraphPort& outside, bool is_input) {
    const Uri uri = *parse_uri(outside.uri);
    // Of shared memory, the writer owns the name.
    const bool is_writer = is_input && uri.scheme == "shm";
    if ((is_writer || uri.scheme.ends_with("-listen")) && !may_listen(uri))
      problems_.add(link.place, "another link also {} {}", is_writer ? "writes to" : "listens at",
                    outside.uri);
    for (const auto& [key, value] : link.policy)
      if (!uri.option(key, "").empty() && !value.value.empty())
        problems_.add(value.place, key + " is also given in " + outside.uri);
    if (uri.scheme == "file" && is_mcap_path(uri.rest))
      problems_.add(link.place,
                    "{} is a recording in MCAP, and links take files of messages: {} is for those",
                    outside.uri, is_input ? "hc play" : "hc run --record");
    const std::string& module = is_input ? link.from.module : link.to.module;
    const Description* description = planning_.description_of(module);
    if (description == nullptr) return;
    const auto known = schemes_of(*description);
    if (std::find(known.begin(), known.end(), uri.scheme) == known.end())
      problems_.add(link.place, "module {} does not support {}: links{}", module, uri.scheme,
                    suggest(planning_, uri.scheme, known));
    else if (auto checked = is_input ? check_outlet(uri) : check_source(uri);
             !checked && is_known_here(uri))
      problems_.add(link.place, outside.uri + ": " + checked.error().detail);
  }

  static Status check_outlet(Uri uri) {
    auto conversion = take_conversion(uri);
    return conversion ? check_sink(uri) : conversion.error();
  }

  /// Whether no other link listens there. A TCP port without a host is on the loopback address, and
  /// 0.0.0.0 takes the port of all addresses.
  bool may_listen(const Uri& uri) {
    if (uri.scheme != "tcp-listen") return listening_.insert(uri.scheme + ":" + uri.rest).second;
    const auto colon = uri.rest.rfind(':');
    std::string host = colon == std::string::npos ? "127.0.0.1" : uri.rest.substr(0, colon);
    if (host == "localhost") host = "127.0.0.1";
    auto& hosts = tcp_hosts_[colon == std::string::npos ? uri.rest : uri.rest.substr(colon + 1)];
    const auto all = [](const std::string& each) { return each == "0.0.0.0"; };
    const bool is_free =
        all(host) ? hosts.empty()
                  : !hosts.contains(host) && std::none_of(hosts.begin(), hosts.end(), all);
    hosts.insert(host);
    return is_free;
  }

  /// A program in another language may support transports unknown to this one.
  static bool is_known_here(const Uri& uri) {
    const auto schemes = transports();
    return std::find(schemes.begin(), schemes.end(), uri.scheme) != schemes.end();
  }

  /// The sender sets the policy of a link, except over shared memory, where the reader sets `keep`,
  /// `rate`, `burst` and `bandwidth`. Each end of a DDS topic has its own.
  void check_outer_policy(const GraphLink& link) {
    const bool is_input = !link.from.uri.empty();
    const std::string& uri = (is_input ? link.from : link.to).uri;
    if (uri.starts_with("dds:")) return;
    const bool is_shared = uri.starts_with("shm:");
    for (const auto& [key, value] : link.policy) {
      if (value.value.empty()) continue;
      const bool is_pace = key == "rate" || key == "burst" || key == "bandwidth";
      if (is_input && !(is_shared && (is_pace || key == "keep")))
        problems_.add(value.place,
                      "a link from outside cannot have " + key + ": its sender sets it");
      if (!is_input && is_shared && is_pace)
        problems_.add(value.place, "a link to shm: cannot have " + key + ": its reader sets it");
    }
  }

  /// Checks that the sender can convert messages as requested, and that the reader takes the
  /// result.
  void check_conversion(const GraphLink& link, const std::vector<PortType>& given,
                        const std::vector<PortType>& taken) {
    if (const auto limit = link.policy.find("bandwidth"); limit != link.policy.end())
      check_bandwidth(link, limit->second, given, taken);
    Uri options;
    const Lined<std::string>* first = nullptr;
    for (const auto key : kConversionOptions) {
      const auto option = link.policy.find(std::string(key));
      if (option == link.policy.end()) continue;
      if (option->second.value.empty()) return;
      options.options.emplace_back(key, option->second.value);
      if (first == nullptr) first = &option->second;
    }
    if (first == nullptr) return;
    if (!planning_.description_of(link.from.module)->control)
      return problems_.add(first->place, kNeedsControl, link.from.module,
                           options.options.front().first);
    const auto conversion = take_conversion(options);
    if (!conversion) return;  // already reported
    if (const auto what = hindrance(*conversion, given, taken); !what.empty())
      problems_.add(first->place, link.from.text() + ": " + what);
  }

  /// The sender must be able to adapt images, and the reader to take them in other sizes.
  void check_bandwidth(const GraphLink& link, const Lined<std::string>& limit,
                       const std::vector<PortType>& given, const std::vector<PortType>& taken) {
    if (!planning_.description_of(link.from.module)->control)
      return problems_.add(limit.place, kNeedsControl, link.from.module, "bandwidth");
    Conversion smaller;
    smaller.scale = 1. / 2;
    if (given.empty() || !can_scale(given.front().info) || link.policy.contains("scale")) return;
    if (const auto what = hindrance(smaller, given, taken); !what.empty())
      problems_.add(limit.place, link.from.text() + ": bandwidth: " + what + "; set scale");
  }

  void check_route(const GraphLink& link) {
    const Description* sender = planning_.description_of(link.from.module);
    if (sender != nullptr && !sender->control)
      problems_.add(link.route->place, kNeedsControl, link.from.module, "route");
    else if (!link.from.uri.empty())
      problems_.add(link.route->place,
                    "a link from outside cannot have a route: its sender sets it");
  }

  Planning& planning_;
  Problems& problems_;
  std::set<std::string> linked_, listening_;
  std::map<std::string, std::set<std::string>> tcp_hosts_;  // by port, where a link listens
};

/// The loop at the end of a path that returns to `module`.
std::string loop_in_words(const std::vector<const GraphLink*>& path, const std::string& module) {
  std::string text = module;
  auto begin = std::find_if(path.begin(), path.end(),
                            [&](const GraphLink* link) { return link->from.module == module; });
  for (auto link = begin; link != path.end(); ++link) text += " -> " + (*link)->to.module;
  return text;
}

}  // namespace

void check_links(Planning& planning) {
  LinkCheck check(planning);
  std::erase_if(planning.graph.links, [&](const auto& link) { return !check.check(link); });
}

/// A loop without a rate runs as fast as the machine can. Links behind a router are ignored, since
/// their messages' addresses are not known here.
void check_loops(Planning& planning) {
  std::map<std::string, std::vector<const GraphLink*>> leaving;
  for (const auto& link : planning.graph.links) {
    const Description* from = planning.description_of(link.from.module);
    const Description* to = planning.description_of(link.to.module);
    // Missing ports have been reported.
    if ((from != nullptr && find_named(from->outputs, link.from.port) == nullptr) ||
        (to != nullptr && find_input(*to, link.to.port) == nullptr))
      continue;
    const bool is_focus = to != nullptr && find_input(*to, link.to.port) == &focus_input();
    const bool is_frames = link.to.port == "frames" && takes_frames(planning, link.to.module);
    if (link.from.uri.empty() && link.to.uri.empty() && !link.policy.contains("rate") &&
        !is_focus && !is_frames && !planning.routes(link.from))
      leaving[link.from.module].push_back(&link);
  }
  std::set<std::string> begun, done;
  std::vector<const GraphLink*> path;
  // Depth first; kMaxModules bounds the depth.
  const std::function<void(const std::string&)> visit = [&](const std::string& module) {
    if (done.contains(module)) return;
    if (!begun.insert(module).second)
      return planning.problems.add(path.back()->place,
                                   "loop without a rate: {}; give one of its links a rate, for "
                                   "example rate = 30",
                                   loop_in_words(path, module));
    for (const auto* link : leaving[module]) {
      path.push_back(link);
      visit(link->to.module);
      path.pop_back();
    }
    done.insert(module);
  };
  for (const auto& module : planning.graph.modules) visit(module.name);
}

/// Synchronised inputs need links at all of them or at none. Not checked for a running graph, in
/// which commands add links one by one.
void check_together(Planning& planning) {
  if (planning.before != nullptr) return;
  std::set<std::string> linked;
  for (const auto& link : planning.graph.links) linked.insert(link.to.text());
  for (const auto& module : planning.graph.modules) {
    const Description* description = planning.description_of(module.name);
    if (description == nullptr) continue;
    for (const auto& group : description->together) {
      std::vector<std::string> there, missing;
      for (const auto& input : group)
        (linked.contains(module.name + "." + input) ? there : missing).push_back(input);
      if (!there.empty() && !missing.empty())
        planning.problems.add(module.place,
                              "module {} takes {} together with {}, which has no link", module.name,
                              joined(there, ", "), joined(missing, ", "));
    }
  }
}

/// Two writers to an actor work against each other, unless an exclusive input or a router lets only
/// one of them through at a time.
void check_actors(Planning& planning) {
  std::map<std::string, std::string> writers;  // first writer, by input
  for (const auto& link : planning.graph.links) {
    const Description* description = planning.description_of(link.to.module);
    if (description == nullptr || planning.routes(link.from)) continue;
    const PortDescription* input = find_named(description->inputs, link.to.port);
    const PlannedModule* planned = planning.planned(link.to.module);
    if (input == nullptr || !input->actor || planned->exclusive.contains(link.to.port)) continue;
    auto [first, is_first] = writers.emplace(link.to.text(), link.from.text());
    if (!is_first)
      planning.problems.add(link.place,
                            "{} is an actor's input and gets commands from {} and {}; make it "
                            "exclusive, or put a router before it",
                            link.to.text(), first->second, link.from.text());
  }
}

}  // namespace hc::internal
