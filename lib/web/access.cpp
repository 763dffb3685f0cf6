// SPDX-License-Identifier: Apache-2.0
#include <web/access.h>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <array>
#include <span>

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <hc/base/check.h>
#include <hc/base/format.h>
#include <hc/base/text.h>
#include <hc/os/secret.h>

namespace hc::web {

namespace {

constexpr std::array<std::string_view, 3> kRights = {"view", "drive", "operate"};
constexpr std::size_t kMaxTokens = 64;

/// "host" and "port" of "host:port"; brackets around an IPv6 address stay.
std::pair<std::string_view, std::string_view> split(std::string_view host) {
  const auto bracket = host.rfind(']');
  const auto colon = host.rfind(':');
  if (colon == std::string_view::npos || (bracket != std::string_view::npos && colon < bracket))
    return {host, {}};
  return {host.substr(0, colon), host.substr(colon + 1)};
}

bool is_address(std::string_view name) {
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  std::array<unsigned char, sizeof(in6_addr)> bytes;
  const std::string text(name);
  return ::inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

/// Compares in constant time.
bool is_same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && ::CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

/// HMAC-SHA256 in hexadecimal digits.
std::string signature(std::string_view text, const std::string& key) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes;
  unsigned size = 0;
  HC_CHECK(::HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
                  reinterpret_cast<const unsigned char*>(text.data()), text.size(), bytes.data(),
                  &size) != nullptr);
  return hexadecimal(std::span(bytes).first(size));
}

}  // namespace

std::string_view name_of(Right right) {
  return kRights.at(static_cast<std::size_t>(right));
}

std::optional<Right> right_named(std::string_view name) {
  return enum_named<Right>(kRights, name);
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

bool is_local(std::string_view name) {
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]" || name == "::1";
}

bool Access::is_host(std::string_view host) const {
  const auto [name, port] = split(host);
  if (!port.empty() && port != std::to_string(place_.port)) return false;
  if (std::ranges::find(place_.hosts, name) != place_.hosts.end()) return true;
  if (is_local(name)) return true;
  return !is_local(place_.address) && is_address(name);
}

bool Access::is_origin(std::string_view origin, std::string_view host) const {
  return origin == std::string(place_.is_secure ? "https://" : "http://") + std::string(host);
}

std::string Access::make_token(Right right) {
  tokens_.emplace_back(make_secret(), right);
  if (tokens_.size() > kMaxTokens) tokens_.pop_front();
  return tokens_.back().first;
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

std::string Access::sign(std::string_view begin) const {
  return signature(cookie_name() + "=" + std::string(begin), key_);
}

std::string Access::begin_session(Right right) {
  const std::string begin = std::string(name_of(right)) + "." + make_secret() + ".";
  return begin + sign(begin);
}

std::optional<Right> Access::right_of_session(std::string_view name) const {
  const auto end = name.rfind('.') + 1;
  if (!is_same(name.substr(end), sign(name.substr(0, end)))) return std::nullopt;
  return right_named(name.substr(0, name.find('.')));
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
