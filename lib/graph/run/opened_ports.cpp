// SPDX-License-Identifier: Apache-2.0
#include <graph/run/opened_ports.h>

#include <unistd.h>

#include <algorithm>
#include <utility>

#include <graph/held_port.h>

namespace hc::internal {
namespace {

using Verb = ModuleCommand::Verb;

// Observers never make a module wait.
constexpr const char* kObserverPolicy = "?readers=0&stay=1&keep=16";

}  // namespace

Result<std::string> OpenedPorts::open(const PlannedModule& module, bool is_input,
                                      const std::string& port, const std::string& name,
                                      MonotonicTime now) {
  auto found = opened_.find({is_input, port});
  if (found == opened_.end()) {
    Opened opened{{is_input, port, {}, {}}, {}};
    HC_TRY(choose_uris(opened, module, name));
    found = opened_.emplace(std::pair(is_input, port), std::move(opened)).first;
    send_({Verb::Link, is_input, found->second.end.text(), {}});
  }
  found->second.until = now + kOpen;
  return found->second.uri;
}

/// The module listens. On another host, both ends use the keys of the hosts.
Status OpenedPorts::choose_uris(Opened& opened, const PlannedModule& module,
                                const std::string& name) const {
  const std::string policy = opened.end.is_input ? "" : kObserverPolicy;
  const auto host = hosts_ == nullptr || module.host.empty() ? nullptr : hosts_->find(module.host);
  if (host) {
    opened.held = HC_TRY(host->spare_port());
    const auto number = ":" + std::to_string(opened.held->number);
    const auto place = host->place();
    const bool is_v6 = place.address.find(':') != std::string::npos;
    opened.end.uri = std::string("tls-listen:") + (is_v6 ? "[::]" : "0.0.0.0") + number +
                     (policy.empty() ? "?" : policy + "&") + "key=" + std::string(kKeyFile) +
                     "&peer=" + hosts_->fingerprint();
    opened.uri = "tls:" + (is_v6 ? "[" + place.address + "]" : place.address) + number +
                 "?key=/proc/" + std::to_string(::getpid()) + "/fd/" +
                 std::to_string(hosts_->key()) + "&peer=" + place.fingerprint;
    return {};
  }
  const bool has_memory =
      !opened.end.is_input &&
      std::ranges::any_of(module.ends, [](const auto& end) { return end.uri.starts_with("shm:"); });
  opened.end.uri = (has_memory ? "shm:" : "unix-listen:@") + name + policy;
  opened.uri = (has_memory ? "shm:" : "unix:@") + name;
  return {};
}

void OpenedPorts::close_unused(const Reports* reports, MonotonicTime now) {
  for (auto& [port, opened] : opened_)
    if (reports == nullptr || reports->peers_of(opened.end) > 0) opened.until = now + kOpen;
  std::erase_if(opened_, [&](const auto& entry) {
    const auto& [end, uri, until, held] = entry.second;
    if (now < until) return false;
    send_({Verb::Unlink, end.is_input, end.text(), {}});
    return true;
  });
}

std::vector<ModuleCommand> OpenedPorts::links() const {
  std::vector<ModuleCommand> links;
  for (const auto& [port, opened] : opened_)
    links.push_back({Verb::Link, opened.end.is_input, opened.end.text(), {}});
  return links;
}

}  // namespace hc::internal
