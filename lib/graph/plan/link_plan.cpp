// SPDX-License-Identifier: Apache-2.0
// Gives each link of a checked graph its two ends.
#include <arpa/inet.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <span>

#include <graph/held_port.h>
#include <graph/plan/planning.h>
#include <graph/plan/routes.h>
#include <hc/base/uri.h>
#include <hc/link/policy.h>

namespace hc::internal {
namespace {

/// Longest name of a link: a socket's name has 107 bytes, of which shared memory takes 17.
constexpr std::size_t kMaxLinkName = 90;

/// A 64-bit hash as 16 hexadecimal digits. Source: FNV-1a,
/// https://datatracker.ietf.org/doc/html/draft-eastlake-fnv
std::string digest(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[hash >> shift & 15];
  return digits;
}

using Keys = std::span<const std::string_view>;

/// Policy keys of the sender: a link with one of them cannot share its sending end; over DDS all
/// but the first count. Then policy keys of the reader; over shared memory only the first two, and
/// the bandwidth, to which the sender adapts images.
constexpr std::array<std::string_view, 6> kOfSender = {"memory", "as",        "quality",
                                                       "scale",  "idle_rate", "bandwidth"};
constexpr std::array<std::string_view, 3> kOfReader = {"rate", "burst", "memory"};
constexpr Keys kConversion = Keys(kOfSender).last<5>(), kPace = Keys(kOfReader).first<2>();
constexpr Keys kBandwidth = Keys(kOfSender).last<1>();
constexpr std::array<std::string_view, 1> kTimeout = {"timeout"};

bool has(Keys keys, const std::string& key) {
  return std::ranges::find(keys, key) != keys.end();
}

/// Adds an option, without the blank in "2 MB/s": a URI has none.
void add_option(Uri& uri, const std::string& key, std::string value) {
  std::erase(value, ' ');
  uri.options.emplace_back(key, std::move(value));
}

/// Adds the options of a link's policy that are among `keys`.
void add_policy(Uri& uri, const GraphLink& link, Keys keys) {
  for (const auto& [key, value] : link.policy)
    if (has(keys, key)) add_option(uri, key, value.value);
}

void add_keep(Uri& uri, const std::string& keep) {
  if (keep != "all") uri.options.emplace_back("keep", keep);
}

bool is_v4(const std::string& address) {
  in_addr read{};
  return ::inet_pton(AF_INET, address.c_str(), &read) == 1;
}

class LinkPlanner {
 public:
  explicit LinkPlanner(Planning& planning)
      : planning_(planning), graph_(planning.graph), drafts_(graph_.links.size()) {}

  void run() {
    find_routes();
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      drafts_[i].keep = keep_of(graph_.links[i]);
      if (is_inside(graph_.links[i])) name_link(graph_.links[i], drafts_[i]);
    }
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      const GraphLink& link = graph_.links[i];
      PlannedLink planned =
          is_inside(link) ? plan_inside(link, drafts_[i]) : plan_outside(link, drafts_[i]);
      for (const auto& [key, value] : link.policy)
        if (key != "keep") planned.policy[key] = value.value;
      planning_.plan.links.push_back(std::move(planned));
    }
  }

 private:
  /// A link before it has ends.
  struct Draft {
    std::string sender_route, reader_route;  // for --route
    std::string keep;
    // Only for links inside the graph:
    const LinkTransport* transport = nullptr;
    std::string name;
    bool is_common = false;  // may share its sending end and name with other links of its output
  };

  /// The sending end of one or more links.
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

  /// Computes --route for both ends of each link.
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
      planning_.problems.add({1, 0},
                             "a path of this graph has {} routers; the ttl of a message allows {}",
                             routes.longest, kMostRouters);
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      const GraphLink& link = graph_.links[i];
      const bool leaves_router = planning_.routes(link.from);
      auto& words = drafts_[i].sender_route;
      if (link.route || leaves_router)
        words = "to=" + (link.routes_all
                             ? "*"
                             : joined(link.route ? link.route->value : routes.passed[i], ","));
      if (leaves_router && link.to.uri.empty()) words += " peer=" + link.to.module;
      if (is_inside(link) && planning_.is_router(link.to.module))
        drafts_[i].reader_route = "peer=" + link.from.module;
    }
  }

  /// Whether a reader waits for the next process of its writer. A reader without `control` does
  /// not, as no command could end its wait.
  bool reconnects(const GraphLink& link) const {
    return !planning_.planned(link.to.module)->control_uri.empty();
  }

  /// Gives a link its transport and a unique name that is the same in every plan of this graph. The
  /// links of an output over shared memory, or over DDS, share a sending end and a name, except for
  /// links with a policy of their sender, and separately for each time-out.
  void name_link(const GraphLink& link, Draft& draft) {
    draft.transport = transport_of(planning_, link);
    const bool is_topic = draft.transport->name == "dds";
    const Keys own = is_topic ? kConversion : Keys(kOfSender);
    draft.is_common =
        (is_topic || draft.transport->name == "shm") && draft.sender_route.empty() &&
        std::ranges::none_of(link.policy, [&](const auto& each) { return has(own, each.first); });
    const std::string& token = planning_.plan.token;
    std::string& name = draft.name = token + "." + link.from.text();
    if (!draft.is_common)
      name += "." + link.to.text();
    else if (const auto timeout = link.policy.find("timeout"); timeout != link.policy.end())
      name += ".timeout_" + timeout->second.value;
    if (name.size() > kMaxLinkName) name = token + "." + digest(name);
    if (is_topic) {  // names of topics have fewer characters
      std::ranges::replace(name, '.', '/');
      std::ranges::replace(name, '-', '_');
    }
    ++senders_[name].readers;
  }

  /// `keep` of a topic's writer: the largest of its readers.
  std::string keep_of_all(const std::string& name) const {
    std::uint64_t most = 1;
    for (const auto& draft : drafts_) {
      if (draft.name != name) continue;
      if (draft.keep == "all") return draft.keep;
      if (draft.keep != "latest") most = std::max<std::uint64_t>(most, std::stoull(draft.keep));
    }
    return most == 1 ? "latest" : std::to_string(most);
  }

  [[nodiscard]] HostPlace place_of(const std::string& host) const {
    auto found = planning_.places.find(host);
    return found == planning_.places.end() ? HostPlace{} : found->second;
  }

  /// The address of a host as seen from another; the host of `hc run` has one for each other host.
  [[nodiscard]] std::string address_of(const std::string& host, const std::string& other) const {
    return host.empty() ? place_of(other).runner : place_of(host).address;
  }

  /// The addresses of the interfaces at one end of a topic.
  std::string interfaces_of(const std::string& name, bool of_writer, const GraphLink& own) {
    const auto hosts_of = [&](const GraphLink& link) {
      std::pair hosts(planning_.host_of(link.from.module), planning_.host_of(link.to.module));
      if (!of_writer) std::swap(hosts.first, hosts.second);
      return hosts;
    };
    std::set<std::string> addresses;
    for (std::size_t i = 0; i < drafts_.size(); ++i)
      if (drafts_[i].name == name && (of_writer || graph_.links[i].to.text() == own.to.text())) {
        const auto hosts = hosts_of(graph_.links[i]);
        addresses.insert(address_of(hosts.first, hosts.second));
      }
    const auto [here, there] = hosts_of(own);
    for (const auto& address : addresses)
      if (!is_v4(address) && !planning_.places.empty())
        planning_.problems.add(
            own.place, "dds needs the IPv4 address of host {}{}: set address = \"…\" in its table",
            here.empty() ? there : here, address.empty() ? "" : ", not " + address);
    return joined(addresses, ",");
  }

  /// `keep` as given, or that of the reader's input; otherwise `latest` for images and `all` for
  /// other types.
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

  /// The TCP port of a link: as in the plan before, or a new one.
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
        planning_.problems.add(link.place, "no port for the link from {} to {}: {}",
                               link.from.text(), link.to.text(), port.error().detail);
    }
    return held == nullptr ? 0 : held->number;
  }

  /// Sets the addresses of a link's two sockets, and the peer that each accepts.
  void connect_sockets(const GraphLink& link, const Draft& draft, Uri& writer, Uri& reader) {
    if (draft.transport->name == "unix") {
      writer.rest = reader.rest = "@" + draft.name;
      return;
    }
    const std::string port = ":" + std::to_string(port_of(link, draft.name));
    if (!planning_.is_between_hosts(link)) {
      writer.rest = reader.rest = "127.0.0.1" + port;
      for (auto* uri : {&writer, &reader}) uri->options.emplace_back("same_user", "1");
      return;
    }
    const std::string &from = planning_.host_of(link.from.module),
                      &to = planning_.host_of(link.to.module);
    const std::string address = address_of(from, to);
    if (address.empty() && !planning_.places.empty())
      planning_.problems.add(
          link.place,
          from.empty()
              ? "host {} has no address of this host that links can use: connect to it by an "
                "address that is not link-local"
              : "host {} has no address that links can use: set address = \"…\" in its table",
          from.empty() ? to : from);
    const bool is_v6 = address.find(':') != std::string::npos;
    writer.rest = (is_v6 ? "[::]" : "0.0.0.0") + port;
    reader.rest = (is_v6 ? "[" + address + "]" : address) + port;
    if (draft.transport->name != "tls") return;
    for (auto [uri, peer] : {std::pair(&writer, &to), {&reader, &from}}) {
      uri->options.emplace_back("key", kKeyFile);
      uri->options.emplace_back("peer", place_of(*peer).fingerprint);
    }
  }

  /// Senders wait for their readers, so the order of starts does not matter. Over shared memory and
  /// DDS each reader applies its own rate and `keep`; over sockets the writer does.
  PlannedLink plan_inside(const GraphLink& link, const Draft& draft) {
    Sender& sender = senders_[draft.name];
    Uri writer{std::string(draft.transport->writer),
               draft.name,
               {{"readers", std::to_string(sender.readers)}, {"stay", "1"}}};
    Uri reader{std::string(draft.transport->reader), draft.name, {{"wait", "60"}}};
    if (reconnects(link)) reader.options = {{"reconnect", "86400"}};
    if (draft.transport->name == "shm") {
      if (!draft.is_common) add_keep(writer, draft.keep);
      add_policy(writer, link, kOfSender);
      add_keep(reader, draft.keep);
      add_policy(reader, link, kPace);
      add_policy(reader, link, kBandwidth);
    } else if (draft.transport->name == "dds") {
      writer.options.emplace_back("interface", interfaces_of(draft.name, true, link));
      reader.options.emplace_back("interface", interfaces_of(draft.name, false, link));
      add_keep(writer, keep_of_all(draft.name));
      add_policy(writer, link, kConversion);
      add_keep(reader, draft.keep);
      add_policy(reader, link, kOfReader);
    } else {
      connect_sockets(link, draft, writer, reader);
      add_keep(writer, draft.keep);
      add_policy(writer, link, kOfSender);
      add_policy(writer, link, kPace);
    }
    add_policy(writer, link, kTimeout);
    add_pair(writer, link);
    if (sender.uri.empty()) {
      sender.uri = writer.text();
      add_end(link.from, {false, link.from.port, sender.uri, draft.sender_route});
    }
    add_end(link.to, {true, link.to.port, reader.text(), draft.reader_route});
    return {link.from.text(), link.to.text(), sender.uri, reader.text(), draft.keep, {},
            reconnects(link)};
  }

  /// Names the reader of a link with a bandwidth, where it takes this input together with others:
  /// the sender then adapts the images of all of them alike.
  void add_pair(Uri& writer, const GraphLink& link) const {
    const Description* reader = planning_.description_of(link.to.module);
    if (!link.policy.contains("bandwidth") || reader == nullptr) return;
    for (const auto& group : reader->together)
      if (std::ranges::find(group, link.to.port) != group.end())
        writer.options.emplace_back("pair", link.to.module + "." + group.front());
  }

  /// Plans a link to or from a URI.
  PlannedLink plan_outside(const GraphLink& link, const Draft& draft) {
    const bool is_input = !link.from.uri.empty();
    Uri uri = *parse_uri(is_input ? link.from.uri : link.to.uri);
    const std::string keep{uri.option("keep", draft.keep)};
    if (uri.option("keep", "").empty()) add_keep(uri, keep);
    for (const auto& [key, value] : link.policy)
      if (key != "keep") add_option(uri, key, value.value);
    PlannedLink planned{link.from.text(), link.to.text(), {}, {}, keep, {}, false};
    (is_input ? planned.reader_uri : planned.sender_uri) = uri.text();
    if (is_input)
      add_end(link.to, {true, link.to.port, uri.text(), draft.reader_route});
    else
      add_end(link.from, {false, link.from.port, uri.text(), draft.sender_route});
    return planned;
  }

  void add_end(const GraphPort& port, PlannedEnd end) {
    planning_.planned(port.module)->ends.push_back(std::move(end));
  }

  Planning& planning_;
  const Graph& graph_;
  std::vector<Draft> drafts_;              // by index of link
  std::map<std::string, Sender> senders_;  // by name
};

/// Whether the modules of a link may make its shared memory, which counts as a file for the limit
/// of the size of files (ulimit -f) that they inherit. That of another host is unknown.
bool may_share_memory(const Planning& planning, const GraphLink& link) {
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  if (limit.rlim_cur == RLIM_INFINITY || !planning.host_of(link.from.module).empty()) return true;
  Uri uri{"shm", "", {}};
  if (const auto given = link.policy.find("memory"); given != link.policy.end())
    uri.options.emplace_back("memory", given->second.value);
  const auto policy = parse_policy(uri);
  return !policy || policy->memory <= limit.rlim_cur;
}

}  // namespace

const LinkTransport* transport_of(const Planning& planning, const GraphLink& link) {
  static constexpr std::array<LinkTransport, 5> kTransports = {{{"shm", "shm", "shm"},
                                                                {"unix", "unix-listen", "unix"},
                                                                {"tcp", "tcp-listen", "tcp"},
                                                                {"tls", "tls-listen", "tls"},
                                                                {"dds", "dds", "dds"}}};
  const Description& from = *planning.description_of(link.from.module);
  const Description& to = *planning.description_of(link.to.module);
  const std::string_view via = link.via.value.empty() ? "tls" : std::string_view(link.via.value);
  const bool is_between = planning.is_between_hosts(link);
  for (const auto& each : kTransports) {
    const bool may_be = is_between ? each.name == via : each.name != "tls" && each.name != "dds";
    if (each.name == "shm" && !may_share_memory(planning, link)) continue;
    if (may_be && from.knows(each.writer) && to.knows(each.reader)) return &each;
  }
  return nullptr;
}

void plan_links(Planning& planning) {
  const auto lacks_memory = [&](const GraphLink& link) {
    if (!link.from.uri.empty() || !link.to.uri.empty() || planning.is_between_hosts(link))
      return false;
    const bool both_know = planning.description_of(link.from.module)->knows("shm") &&
                           planning.description_of(link.to.module)->knows("shm");
    return both_know && !may_share_memory(planning, link);
  };
  if (std::ranges::any_of(planning.graph.links, lacks_memory))
    planning.problems.warn({}, "ulimit -f is below the shared memory of links; they use sockets");
  LinkPlanner(planning).run();
}

}  // namespace hc::internal
