// SPDX-License-Identifier: Apache-2.0
#include <web/access.h>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/random.h>

#include <algorithm>
#include <array>

#include <hc/base/check.h>

namespace hc::web {

namespace {

constexpr std::array<std::string_view, 3> kRights = {"view", "drive", "operate"};
constexpr std::size_t kMaxTokens = 64, kMaxSessions = 1024;

/// "host" and "port" of "host:port"; brackets around an IPv6 address stay.
std::pair<std::string_view, std::string_view> split(std::string_view host) {
  const auto bracket = host.rfind(']');
  const auto colon = host.rfind(':');
  if (colon == std::string_view::npos || (bracket != std::string_view::npos && colon < bracket))
    return {host, {}};
  return {host.substr(0, colon), host.substr(colon + 1)};
}

bool is_loopback(std::string_view name) {
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]" || name == "::1";
}

bool is_address(std::string_view name) {
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  std::array<unsigned char, sizeof(in6_addr)> bytes;
  const std::string text(name);
  return ::inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

/// Compares in a time that does not say how much of it was right.
bool is_same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different |= static_cast<unsigned>(static_cast<unsigned char>(a[i] ^ b[i]));
  return different == 0;
}

template <typename Secrets>
std::string add(Secrets& secrets, Right right, std::size_t limit) {
  secrets.emplace_back(make_secret(), right);
  if (secrets.size() > limit) secrets.pop_front();
  return secrets.back().first;
}

}  // namespace

std::string_view name_of(Right right) {
  return kRights.at(static_cast<std::size_t>(right));
}

std::optional<Right> right_named(std::string_view name) {
  const auto found = std::ranges::find(kRights, name);
  if (found == kRights.end()) return std::nullopt;
  return static_cast<Right>(found - kRights.begin());
}

std::string own_address() {
  std::string found = "127.0.0.1";
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return found;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const bool is_up = (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_up || each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) == nullptr) continue;
    found = text.data();
    break;
  }
  ::freeifaddrs(all);
  return found;
}

std::string make_secret() {
  std::array<unsigned char, 16> bytes;
  HC_CHECK(::getrandom(bytes.data(), bytes.size(), 0) == std::ssize(bytes));
  std::string text;
  for (const unsigned byte : bytes) {
    text += "0123456789abcdef"[byte / 16];
    text += "0123456789abcdef"[byte % 16];
  }
  return text;
}

bool Access::is_host(std::string_view host) const {
  const auto [name, port] = split(host);
  if (!port.empty() && port != std::to_string(place_.port)) return false;
  if (std::ranges::find(place_.hosts, name) != place_.hosts.end()) return true;
  if (is_loopback(name)) return true;
  return !is_loopback(place_.address) && is_address(name);
}

bool Access::is_origin(std::string_view origin, std::string_view host) const {
  return origin == std::string(place_.is_secure ? "https://" : "http://") + std::string(host);
}

std::string Access::make_token(Right right) {
  return add(tokens_, right, kMaxTokens);
}

std::string Access::authority() const {
  const bool is_any = place_.address == "0.0.0.0" || place_.address == "::";
  std::string host = !is_any                ? place_.address
                     : place_.hosts.empty() ? own_address()
                                            : place_.hosts.front();
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return host + ":" + std::to_string(place_.port);
}

std::string Access::invite(Right right) {
  return std::string(place_.is_secure ? "https://" : "http://") + authority() +
         "/?token=" + make_token(right);
}

std::string Access::invite_socket(Right right) {
  return std::string(place_.is_secure ? "wss://" : "ws://") + authority() +
         "/?token=" + begin_session(right);
}

std::optional<std::string> Access::redeem(std::string_view token) {
  const auto found =
      std::ranges::find_if(tokens_, [&](const auto& each) { return is_same(each.first, token); });
  if (found == tokens_.end()) return std::nullopt;
  const Right right = found->second;
  tokens_.erase(found);
  return begin_session(right);
}

std::string Access::begin_session(Right right) {
  return add(sessions_, right, kMaxSessions);
}

std::optional<Right> Access::right_of_session(std::string_view name) const {
  for (const auto& [session, right] : sessions_)
    if (is_same(session, name)) return right;
  return std::nullopt;
}

std::optional<Right> Access::right_of(std::string_view cookies) const {
  const std::string name = cookie_name() + "=";
  while (!cookies.empty()) {
    auto cookie = cookies.substr(0, cookies.find(';'));
    cookies.remove_prefix(std::min(cookies.size(), cookie.size() + 1));
    while (cookie.starts_with(' ')) cookie.remove_prefix(1);
    if (!cookie.starts_with(name)) continue;
    cookie.remove_prefix(name.size());
    if (const auto right = right_of_session(cookie)) return right;
  }
  return std::nullopt;
}

}  // namespace hc::web
