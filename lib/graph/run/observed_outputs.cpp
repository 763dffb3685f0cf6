// SPDX-License-Identifier: Apache-2.0
#include <graph/run/observed_outputs.h>

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

Result<std::string> ObservedOutputs::open(const PlannedModule& module, const std::string& port,
                                          const std::string& name, MonotonicTime now) {
  auto found = observed_.find(port);
  if (found == observed_.end()) {
    Observed observed{{false, port, {}, {}}, {}};
    HC_TRY(choose_uris(observed, module, name));
    found = observed_.emplace(port, std::move(observed)).first;
    send_({Verb::Link, false, found->second.end.text(), {}});
  }
  found->second.until = now + kObserved;
  return found->second.uri;
}

/// On another host, the output and its observers use the keys of the hosts.
Status ObservedOutputs::choose_uris(Observed& observed, const PlannedModule& module,
                                    const std::string& name) const {
  const auto host = hosts_ == nullptr || module.host.empty() ? nullptr : hosts_->find(module.host);
  if (host) {
    observed.held = HC_TRY(host->spare_port());
    const auto number = ":" + std::to_string(observed.held->number);
    const auto place = host->place();
    const bool is_v6 = place.address.find(':') != std::string::npos;
    observed.end.uri = std::string("tls-listen:") + (is_v6 ? "[::]" : "0.0.0.0") + number +
                       kObserverPolicy + "&key=" + std::string(kKeyFile) +
                       "&peer=" + hosts_->fingerprint();
    observed.uri = "tls:" + (is_v6 ? "[" + place.address + "]" : place.address) + number +
                   "?key=/proc/" + std::to_string(::getpid()) + "/fd/" +
                   std::to_string(hosts_->key()) + "&peer=" + place.fingerprint;
    return {};
  }
  const bool has_memory =
      std::ranges::any_of(module.ends, [](const auto& end) { return end.uri.starts_with("shm:"); });
  observed.end.uri = (has_memory ? "shm:" : "unix-listen:@") + name + kObserverPolicy;
  observed.uri = (has_memory ? "shm:" : "unix:@") + name;
  return {};
}

void ObservedOutputs::close_unread(const Reports* reports, MonotonicTime now) {
  for (auto& [port, observed] : observed_)
    if (reports == nullptr || reports->peers_of(observed.end) > 0) observed.until = now + kObserved;
  std::erase_if(observed_, [&](const auto& entry) {
    const bool is_over = now >= entry.second.until;
    if (is_over) send_({Verb::Unlink, false, entry.second.end.text(), {}});
    return is_over;
  });
}

std::vector<ModuleCommand> ObservedOutputs::links() const {
  std::vector<ModuleCommand> links;
  for (const auto& [port, observed] : observed_)
    links.push_back({Verb::Link, false, observed.end.text(), {}});
  return links;
}

}  // namespace hc::internal
