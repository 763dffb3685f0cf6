// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/senders.h>

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include <hc/os/peer_user.h>

namespace hc {
namespace {

constexpr std::size_t kMostChecks = 8;  // so that many senders do not starve the module

/// Converts an IPv4-mapped IPv6 address to IPv4.
sockaddr_storage plain(const sockaddr_storage& from) {
  const auto& six = reinterpret_cast<const sockaddr_in6&>(from);
  if (from.ss_family != AF_INET6 || !IN6_IS_ADDR_V4MAPPED(&six.sin6_addr)) return from;
  sockaddr_storage made{};
  auto& four = reinterpret_cast<sockaddr_in&>(made);
  four.sin_family = AF_INET;
  four.sin_port = six.sin6_port;
  std::memcpy(&four.sin_addr, &six.sin6_addr.s6_addr[12], sizeof four.sin_addr);
  return made;
}

std::string host_of(const sockaddr_storage& from) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* address = &reinterpret_cast<const sockaddr_in&>(from).sin_addr;
  if (from.ss_family == AF_INET6) address = &reinterpret_cast<const sockaddr_in6&>(from).sin6_addr;
  return ::inet_ntop(from.ss_family, address, text.data(), text.size()) == nullptr ? "?"
                                                                                   : text.data();
}

}  // namespace

Status Senders::admit(const sockaddr_storage& sender, MonotonicTime now) {
  const sockaddr_storage from = plain(sender);
  const std::string host = host_of(from);
  // The port has the same offset in both families.
  const std::string address =
      host + " port " + std::to_string(ntohs(reinterpret_cast<const sockaddr_in&>(from).sin_port));
  if (const auto* holder = turn_.holder(now); holder != nullptr && *holder != address)
    return Error{Code::Closed, "another sender, " + address + ", while " + *holder + " sends"};
  if (auto status = check(from, host, address); !status) {
    turn_.release(address);
    return status;
  }
  turn_.take(address, now);
  return {};
}

Status Senders::check(const sockaddr_storage& from, const std::string& host,
                      const std::string& address) {
  const auto known = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& each) { return each.address == address; });
  if (known != known_.end()) return known->status;
  if (known_.size() == kMostChecks) return Error{Code::Closed, "one of many senders, " + address};
  const auto user = user_of_(from);
  Status status;
  if (!user)
    status = Error{Code::Closed, address + ", an unknown user: " + user.error().detail};
  else if (*user)
    status = check_own(**user, address + ", ");
  else if (std::find(hosts_.begin(), hosts_.end(), host) == hosts_.end())
    status = Error{Code::Closed, address + ": another host, not listed in `sender`"};
  known_.push_back({address, status});
  return status;
}

}  // namespace hc
