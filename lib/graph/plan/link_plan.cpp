// SPDX-License-Identifier: Apache-2.0
// Gives each link of a graph, which has been checked, its two ends.
#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <span>

#include <graph/held_port.h>
#include <graph/plan/planning.h>
#include <graph/plan/routes.h>
#include <hc/base/uri.h>

namespace hc::internal {
namespace {

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

/// Keys of a policy that need a sending end of the link's own, over sockets or shared memory and
/// over DDS; one that links with an end in common have in common; and those that a reader of shared
/// memory, and of a topic, keeps.
constexpr std::array<std::string_view, 4> kOfSender = {"memory", "as", "quality", "scale"};
constexpr auto kConversion = std::span(kOfSender).subspan<1>();
constexpr std::array<std::string_view, 1> kTimeout = {"timeout"};
constexpr std::array<std::string_view, 3> kOfTopicReader = {"rate", "burst", "memory"};
constexpr auto kPace = std::span(kOfTopicReader).first<2>();

/// Some options of a link's policy, as they are in a URI.
std::string options_of(const GraphLink& link, std::span<const std::string_view> keys) {
  std::string options;
  for (const auto& [key, value] : link.policy)
    if (std::find(keys.begin(), keys.end(), key) != keys.end())
      options.append("&").append(key).append("=").append(value.value);
  return options;
}

class LinkPlanner {
 public:
  explicit LinkPlanner(Planning& planning) : planning_(planning), graph_(planning.graph) {}

  void run() {
    find_routes();
    for (std::size_t i = 0; i < graph_.links.size(); ++i) {
      names_.push_back(is_inside(graph_.links[i]) ? name_of(i) : "");
      if (!names_[i].empty()) ++senders_[names_[i]].readers;
    }
    for (std::size_t i = 0; i < graph_.links.size(); ++i) {
      PlannedLink planned = is_inside(graph_.links[i]) ? plan_inside(i) : plan_outside(i);
      for (const auto& [key, value] : graph_.links[i].policy)
        if (key != "keep") planned.policy[key] = value.value;
      planning_.plan.links.push_back(std::move(planned));
    }
  }

 private:
  /// The sending end of a link, or of several that share its memory.
  struct Sender {
    std::size_t readers = 0;
    std::string uri;
  };

  static bool is_inside(const GraphLink& link) {
    return link.from.uri.empty() && link.to.uri.empty();
  }

  std::size_t number_of(const GraphPort& port) const {
    return port.uri.empty() ? planning_.index.at(port.module) : kOutside;
  }

  /// The words of --route at both ends of each link.
  void find_routes() {
    std::vector<RoutedLink> links;
    std::vector<bool> is_router;
    for (const auto& module : planning_.plan.modules)
      is_router.push_back(planning_.is_router(module.name));
    for (const auto& link : graph_.links) {
      RoutedLink& routed = links.emplace_back();
      routed.from = planning_.routes(link.from) ? number_of(link.from) : kOutside;
      routed.to = number_of(link.to);
      if (link.route) routed.given = link.route->value;
      auto address = planning_.plan.addresses.find(link.to.text());
      if (address != planning_.plan.addresses.end()) routed.reaches = address->second;
    }
    constexpr std::size_t kMostRouters = 7;  // R42: the eighth would leave a ttl of 8 with 0
    const Routes routes = compute_routes(links, is_router);
    if (routes.longest > kMostRouters)
      planning_.problems.add({1, 0}, "a message passes " + std::to_string(routes.longest) +
                                         " routers on a way of this graph, and its ttl is for " +
                                         std::to_string(kMostRouters));
    for (std::size_t i = 0; i < graph_.links.size(); ++i)
      routes_.push_back(words_of(graph_.links[i], routes.passed[i]));
  }

  struct RouteWords {
    std::string sender, reader;
  };

  [[nodiscard]] RouteWords words_of(const GraphLink& link,
                                    const std::vector<std::int64_t>& passed) const {
    const bool leaves_router = planning_.routes(link.from);
    RouteWords words;
    std::string addresses;
    for (auto address : link.route ? link.route->value : passed)
      addresses += (addresses.empty() ? "" : ",") + std::to_string(address);
    if (link.routes_all) addresses = "*";
    if (link.route || leaves_router) words.sender = "to=" + addresses;
    if (leaves_router && link.to.uri.empty()) words.sender += " peer=" + link.to.module;
    if (link.from.uri.empty() && link.to.uri.empty() && planning_.is_router(link.to.module))
      words.reader = "peer=" + link.from.module;
    return words;
  }

  /// A link's name: the same in every plan of this graph, and no other's.
  [[nodiscard]] std::string link_name(std::initializer_list<std::string> words) const {
    std::string name = planning_.plan.token;
    for (const auto& word : words) name += "." + word;
    if (name.size() <= kMaxLinkName) return name;
    return planning_.plan.token + "." + digest(name);
  }

  /// Whether a reader waits for the next process of its writer. One without `control` could not be
  /// informed that none will come.
  bool lasts(const GraphLink& link) const {
    return !planning_.planned(link.to.module)->control_uri.empty();
  }

  /// Whether links of an output have an end in common with this one: by memory, or a topic.
  bool is_common(std::size_t number) const {
    const GraphLink& link = graph_.links[number];
    const auto transport = transport_of(planning_, link);
    const bool by_topic = transport == "dds";
    const auto own = by_topic ? std::span<const std::string_view>(kConversion) : kOfSender;
    const bool is_own = std::ranges::any_of(
        own, [&](const auto key) { return link.policy.contains(std::string(key)); });
    return (transport == "shm" || by_topic) && !is_own && routes_[number].sender.empty();
  }

  std::string name_of(std::size_t number) const {
    const GraphPort& from = graph_.links[number].from;
    const GraphPort& to = graph_.links[number].to;
    std::string name;
    if (!is_common(number))
      name = link_name({from.module, from.port, to.module, to.port});
    else if (const auto& policy = graph_.links[number].policy; policy.contains("timeout"))
      name = link_name({from.module, from.port, "timeout_" + policy.at("timeout").value});
    else
      name = link_name({from.module, from.port});
    return transport_of(planning_, graph_.links[number]) == "dds" ? topic_of(name) : name;
  }

  /// A name as a topic of DDS, whose letters are fewer.
  static std::string topic_of(std::string name) {
    std::ranges::replace(name, '.', '/');
    std::ranges::replace(name, '-', '_');
    return name;
  }

  /// What all readers of a topic let their writer do: it waits for none where each of them drops.
  std::string keep_of_all(const std::string& name) const {
    std::uint64_t most = 1;
    for (std::size_t i = 0; i < graph_.links.size(); ++i) {
      if (names_[i] != name) continue;
      std::string keep = keep_of(graph_.links[i]);
      if (keep == "all") return keep;
      if (keep != "latest") most = std::max<std::uint64_t>(most, std::stoull(keep));
    }
    return most == 1 ? "latest" : std::to_string(most);
  }

  /// The addresses by which the two ends of a topic reach each other, of which the host of `hc run`
  /// has one for each of the others.
  std::string interfaces_of(const std::string& name, bool of_writer, const GraphLink& own) {
    const auto address_of = [&](const GraphLink& link) {
      const std::string &here = planning_.host_of((of_writer ? link.from : link.to).module),
                        &there = planning_.host_of((of_writer ? link.to : link.from).module);
      return here.empty() ? place_of(there).runner : place_of(here).address;
    };
    std::set<std::string> addresses;
    for (std::size_t i = 0; i < graph_.links.size(); ++i)
      if (names_[i] == name && (of_writer || graph_.links[i].to.text() == own.to.text()))
        addresses.insert(address_of(graph_.links[i]));
    std::string list;
    for (const auto& address : addresses) {
      if (!is_v4(address) && !planning_.places.empty()) {
        const std::string &from = planning_.host_of(own.from.module),
                          &to = planning_.host_of(own.to.module);
        const std::string &here = of_writer ? from : to, &there = of_writer ? to : from;
        planning_.problems.add(own.place, "dds needs the IPv4 address of host " +
                                              (here.empty() ? there : here) +
                                              (address.empty() ? "" : ", not " + address) +
                                              ": say address = \"…\" in its table");
      }
      list += (list.empty() ? "" : ",") + address;
    }
    return list;
  }

  static bool is_v4(const std::string& address) {
    in_addr read{};
    return ::inet_pton(AF_INET, address.c_str(), &read) == 1;
  }

  /// What the reader says of its input; images are as good as they are new, so that the newest
  /// alone waits for who is slow; of anything else all.
  std::string keep_of(const GraphLink& link) const {
    if (auto given = link.policy.find("keep"); given != link.policy.end())
      return given->second.value;
    if (!link.from.uri.empty() || link.to.uri.starts_with("file:")) return "all";
    if (const Description* reader = planning_.description_of(link.to.module); reader != nullptr)
      if (const auto keep = find_input(*reader, link.to.port)->keep; keep != 0)
        return keep == 1 ? "latest" : std::to_string(keep);
    const Description& description = *planning_.description_of(link.from.module);
    const auto& types = find_output(description, link.from.port)->types;
    bool is_image = !types.empty() && (types.front().info.type == MatrixType::RgbImage ||
                                       types.front().info.type == MatrixType::IntensityImage);
    return is_image ? "latest" : "all";
  }

  /// The TCP port of a link, as before; else one of its own.
  int port_of(const GraphLink& link, const std::string& name) {
    const std::string& host = planning_.host_of(link.from.module);
    const bool is_for_others = planning_.is_between_hosts(link);
    const std::string key = name + (host.empty() ? "" : "@" + host) + (is_for_others ? "+" : "");
    auto& held = planning_.plan.ports[key];
    if (planning_.before != nullptr)
      if (auto kept = planning_.before->ports.find(key); kept != planning_.before->ports.end())
        held = kept->second;
    if (held == nullptr && planning_.hold_port) {
      auto port = planning_.hold_port(host, is_for_others);
      if (port)
        held = *port;
      else
        planning_.problems.add(link.place, "no port for the link from " + link.from.text() +
                                               " to " + link.to.text() + ": " +
                                               port.error().detail);
    }
    return held == nullptr ? 0 : held->number;
  }

  /// The URIs of a link's two ends, and what each has beside the options of every link in a graph.
  struct Ends {
    std::string writer, reader, writer_options, reader_options;
  };

  /// The links of an output that share memory have one sending end in common, but for those that
  /// have a bound or a route of their own, and each reader keeps its rate; every other link has a
  /// socket. All links of an output by DDS have a topic in common, and each reader keeps its rate,
  /// and drops by its own policy.
  Ends ends_of(std::size_t number, const std::string& keep) {
    const GraphLink& link = graph_.links[number];
    const std::string transport(transport_of(planning_, link));
    const std::string &name = names_[number], place = transport + ":" + name;
    const auto and_keep = [](const std::string& kept) {
      return kept == "all" ? "" : "&keep=" + kept;
    };
    const std::string timeout = options_of(link, kTimeout), pace = options_of(link, kPace);
    if (transport == "shm")
      return {place, place,
              (is_common(number) ? "" : and_keep(keep)) + options_of(link, kOfSender) + timeout,
              and_keep(keep) + pace};
    if (transport == "dds")
      return {place, place,
              "&interface=" + interfaces_of(name, true, link) + and_keep(keep_of_all(name)) +
                  options_of(link, kConversion) + timeout,
              "&interface=" + interfaces_of(name, false, link) + and_keep(keep) +
                  options_of(link, kOfTopicReader)};
    Ends ends = sockets_of(link, transport, name);
    ends.writer = transport + "-listen:" + ends.writer;
    ends.reader = transport + ":" + ends.reader;
    ends.writer_options += and_keep(keep) + options_of(link, kOfSender) + timeout + pace;
    return ends;
  }

  /// Where the writer of a link listens, where its reader connects to, and whom each lets in.
  Ends sockets_of(const GraphLink& link, std::string_view transport, const std::string& name) {
    if (transport == "unix") return {"@" + name, "@" + name, "", ""};
    const std::string port = ":" + std::to_string(port_of(link, name));
    if (!planning_.is_between_hosts(link))
      return {"127.0.0.1" + port, "127.0.0.1" + port, "&same_user=1", "&same_user=1"};
    const std::string &from = planning_.host_of(link.from.module),
                      &to = planning_.host_of(link.to.module);
    // The host of `hc run` is where each of the others sees it.
    std::string address = place_of(from.empty() ? to : from).*
                          (from.empty() ? &HostPlace::runner : &HostPlace::address);
    if (address.empty() && !planning_.places.empty())
      planning_.problems.add(
          link.place,
          from.empty()
              ? "host " + to + " has no address of this one that links can use: connect to it by " +
                    "another, not a link-local one"
              : "host " + from +
                    " has no address that links can use: say address = \"…\" in its table");
    const bool is_v6 = address.find(':') != std::string::npos;
    if (is_v6) address = "[" + address + "]";
    Ends ends{(is_v6 ? "[::]" : "0.0.0.0") + port, address + port, "", ""};
    if (transport == "tls") {
      const std::string key = "&key=" + std::string(kKeyFile) + "&peer=";
      ends.writer_options = key + place_of(to).fingerprint;
      ends.reader_options = key + place_of(from).fingerprint;
    }
    return ends;
  }

  [[nodiscard]] HostPlace place_of(const std::string& host) const {
    auto found = planning_.places.find(host);
    return found == planning_.places.end() ? HostPlace{} : found->second;
  }

  /// Senders wait for their readers, so that it does not matter who starts first.
  PlannedLink plan_inside(std::size_t number) {
    const GraphLink& link = graph_.links[number];
    const std::string keep = keep_of(link);
    const Ends ends = ends_of(number, keep);
    Sender& sender = senders_[names_[number]];
    if (sender.uri.empty()) {
      sender.uri = ends.writer + "?readers=" + std::to_string(sender.readers) + "&stay=1" +
                   ends.writer_options;
      add_end(link.from, {false, link.from.port, sender.uri, routes_[number].sender});
    }
    const std::string reader_uri =
        ends.reader + (lasts(link) ? "?reconnect=86400" : "?wait=60") + ends.reader_options;
    add_end(link.to, {true, link.to.port, reader_uri, routes_[number].reader});
    return {link.from.text(), link.to.text(), sender.uri, reader_uri, keep, {}, lasts(link)};
  }

  /// A link with the world outside is as the file says.
  PlannedLink plan_outside(std::size_t number) {
    const GraphLink& link = graph_.links[number];
    const bool is_input = !link.from.uri.empty();
    Uri uri = *parse_uri(is_input ? link.from.uri : link.to.uri);
    const std::string keep{uri.option("keep", keep_of(link))};
    if (keep != "all" && uri.option("keep", "").empty()) uri.options.emplace_back("keep", keep);
    for (const auto& [key, value] : link.policy)
      if (key != "keep") uri.options.emplace_back(key, value.value);
    const std::string text = uri.text();
    if (is_input)
      add_end(link.to, {true, link.to.port, text, routes_[number].reader});
    else
      add_end(link.from, {false, link.from.port, text, routes_[number].sender});
    return {link.from.text(),
            link.to.text(),
            is_input ? "" : text,
            is_input ? text : "",
            keep,
            {},
            false};
  }

  void add_end(const GraphPort& port, PlannedEnd end) {
    planning_.planned(port.module)->ends.push_back(std::move(end));
  }

  Planning& planning_;
  const Graph& graph_;
  std::vector<RouteWords> routes_;         // by number of a link
  std::vector<std::string> names_;         // the same; of links inside the graph
  std::map<std::string, Sender> senders_;  // by name
};

}  // namespace

std::string_view transport_of(const Planning& planning, const GraphLink& link) {
  const Description& from = *planning.description_of(link.from.module);
  const Description& to = *planning.description_of(link.to.module);
  if (planning.is_between_hosts(link)) {
    if (link.via.value == "dds") return from.knows("dds") && to.knows("dds") ? "dds" : "";
    const bool is_plain = link.via.value == "tcp";
    if (is_plain) return from.knows("tcp-listen") && to.knows("tcp") ? "tcp" : "";
    return from.knows("tls-listen") && to.knows("tls") ? "tls" : "";
  }
  if (from.knows("shm") && to.knows("shm")) return "shm";
  if (from.knows("unix-listen") && to.knows("unix")) return "unix";
  if (from.knows("tcp-listen") && to.knows("tcp")) return "tcp";
  return "";
}

void plan_links(Planning& planning) {
  LinkPlanner(planning).run();
}

}  // namespace hc::internal
