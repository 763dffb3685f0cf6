// SPDX-License-Identifier: Apache-2.0
#include <graph/run/held_names.h>

#include <fcntl.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include <graph/plan.h>
#include <hc/base/uri.h>
#include <hc/link/shm/greeting.h>
#include <hc/link/stream/ends.h>

namespace hc::internal {
namespace {

/// The socket to which the readers of an argument of `--out` connect; nullopt for other links.
std::optional<Uri> socket_of(const std::string& argument) {
  const auto uri = parse_uri(argument.substr(argument.find('=') + 1));
  if (uri && uri->scheme == "shm") return meeting_place(*uri);
  if (uri && uri->scheme == "unix-listen" && uri->rest.starts_with('@')) return *uri;
  return {};
}

}  // namespace

Status HeldNames::hold(const std::vector<std::string>& command) {
  std::map<std::string, Descriptor> wanted;
  const bool takes_them = std::find(command.begin(), command.end(), "--control") != command.end();
  for (std::size_t i = 0; takes_them && i + 1 < command.size(); ++i) {
    const auto socket = command[i] == "--out" ? socket_of(command[i + 1]) : std::nullopt;
    if (!socket) continue;
    if (auto before = held_.find(socket->rest); before != held_.end()) {
      wanted[socket->rest] = std::move(before->second);
      held_.erase(before);
    } else if (!wanted.contains(socket->rest)) {
      auto listening = HC_TRY(listen_unix(*socket));
      // kKeyDescriptor is reserved in the program.
      const int kept = ::fcntl(listening.descriptor.get(), F_DUPFD_CLOEXEC, kKeyDescriptor + 1);
      if (kept < 0) return system_error("fcntl", socket->rest);
      wanted[socket->rest] = Descriptor(kept);
    }
  }
  held_ = std::move(wanted);
  return {};
}

std::vector<int> HeldNames::descriptors() const {
  std::vector<int> numbers;
  for (const auto& [name, descriptor] : held_) numbers.push_back(descriptor.get());
  return numbers;
}

}  // namespace hc::internal
