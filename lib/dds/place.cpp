// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string_view>

#include <dds/place.h>
#include <hc/base/text.h>
#include <hc/link/link.h>
#include <hc/os/descriptor.h>

namespace hc::dds {
namespace {

constexpr std::int64_t kLastDomain = 232;  // the last with valid port numbers
constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kLongestTopic = 255;  // limit of discovery [byte]

bool is_topic(std::string_view text) {
  const auto may_be = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/';
  };
  return !text.empty() && text.size() <= kLongestTopic && !(text[0] >= '0' && text[0] <= '9') &&
         std::all_of(text.begin(), text.end(), may_be);
}

std::string element(std::string_view name, const std::string& content) {
  std::string text = "<";
  text.append(name).append(">").append(content).append("</").append(name).append(">");
  return text;
}

}  // namespace

Result<Place> parse_place(const Uri& uri) {
  Place place{uri.rest, 0, {}};
  if (!is_topic(place.topic))
    return Error{Code::Invalid, "\"" + uri.rest +
                                    "\" is not a DDS topic: use letters, digits, _ and /, not "
                                    "starting with a digit"};
  const auto domain = HC_TRY(number_option(uri, "domain", 0, {0, kLastDomain}));
  place.domain = static_cast<std::uint32_t>(domain);
  for (auto list = uri.option("interface", ""); !list.empty();) {
    const std::string address(take_until(list, ','));
    in_addr read{};
    if (::inet_pton(AF_INET, address.c_str(), &read) != 1)
      return Error{Code::Invalid,
                   "option interface takes IPv4 addresses of this host, separated by "
                   "commas, not \"" +
                       address + "\""};
    if (address != kLoopback) place.addresses.push_back(address);
  }
  return place;
}

Result<std::vector<unsigned>> find_interfaces(const Place& place) {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return system_error("getifaddrs", "");
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> all(first, &::freeifaddrs);
  const auto number_of = [&](const std::string& address) {
    for (const auto* each = all.get(); each != nullptr; each = each->ifa_next) {
      if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET ||
          (each->ifa_flags & IFF_UP) == 0)
        continue;
      char text[INET_ADDRSTRLEN] = {};
      const auto* own = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
      ::inet_ntop(AF_INET, &own->sin_addr, text, sizeof text);
      if (address == text) return ::if_nametoindex(each->ifa_name);
    }
    return 0U;
  };
  std::vector<unsigned> numbers = {number_of(kLoopback)};
  for (const auto& address : place.addresses) {
    numbers.push_back(number_of(address));
    if (numbers.back() == 0)
      return Error{Code::NotFound,
                   "no network interface of this host that is up has the address " + address};
  }
  return numbers;
}

std::string configuration(const Place& place, std::uint64_t max_bytes) {
  const bool is_loopback = place.addresses.empty();
  std::string interfaces;
  for (const auto& address : is_loopback ? std::vector<std::string>{kLoopback} : place.addresses)
    interfaces += "<NetworkInterface address=\"" + address + "\"/>";
  std::string general = element("Interfaces", interfaces);
  // The lease is the time after which a participant that died is noticed, unless asked earlier.
  std::string discovery =
      element("ExternalDomainId", std::to_string(place.domain)) + element("LeaseDuration", "3 s");
  if (is_loopback) {
    // Loopback loses no fragments of large packets. It has no multicast, so all ports that a
    // participant may have are probed.
    constexpr int kLastIndex = 119;  // the last whose ports belong to this domain
    general += element("AllowMulticast", "false") + element("MaxMessageSize", "65500 B") +
               element("FragmentSize", "65000 B");
    discovery += element("ParticipantIndex", "auto") +
                 element("MaxAutoParticipantIndex", std::to_string(kLastIndex)) +
                 element("Peers", "<Peer address=\"127.0.0.1\"/>");
  }
  std::string text =
      element("General", general) + element("Discovery", discovery) +
      // The watermarks bound unacknowledged data; acknowledged data is bounded by the reader's
      // link.
      element("Internal", element("MaxSampleSize", std::to_string(max_bytes) + " B") +
                              element("NackDelay", "10 ms") +
                              R"(<SocketReceiveBufferSize min="default" max="8 MB"/>)" +
                              element("Watermarks", element("WhcHigh", "4 MB") +
                                                        element("WhcHighInit", "4 MB") +
                                                        element("WhcAdaptive", "false")));
  // The user's settings for Cyclone DDS take precedence: tuning, security.
  if (const char* own = std::getenv("CYCLONEDDS_URI"); own != nullptr && *own != '\0')
    text.append(",").append(own);
  return text;
}

}  // namespace hc::dds
