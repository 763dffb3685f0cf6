// SPDX-License-Identifier: Apache-2.0
#include <hc/os/udp_sender.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <ios>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <hc/os/socket.h>

namespace hc {
namespace {

/// An address as in /proc/net: words in hexadecimal, the port after a colon.
std::string in_hexadecimal(std::span<const std::uint32_t> words, in_port_t port) {
  std::ostringstream text;
  text << std::hex << std::uppercase << std::setfill('0');
  for (const std::uint32_t word : words) text << std::setw(8) << word;
  text << ':' << std::setw(4) << ntohs(port);
  return text.str();
}

/// The local addresses, as in /proc/net/udp and udp6, of sockets that may send from `from`: those
/// bound to it or to any address.
std::vector<std::string> local_addresses(const sockaddr_storage& from) {
  std::array<std::uint32_t, 4> words{};
  const in_port_t port =
      reinterpret_cast<const sockaddr_in&>(from).sin_port;  // sin6_port has the same offset
  if (from.ss_family == AF_INET)
    words[0] = reinterpret_cast<const sockaddr_in&>(from).sin_addr.s_addr;
  else
    std::memcpy(words.data(), &reinterpret_cast<const sockaddr_in6&>(from).sin6_addr, sizeof words);
  const std::array<std::uint32_t, 4> any{};
  if (from.ss_family == AF_INET) {
    const std::array<std::uint32_t, 4> mapped{0, 0, htonl(0xFFFF), words[0]};
    return {in_hexadecimal(std::span(words).first(1), port),
            in_hexadecimal(std::span(any).first(1), port), in_hexadecimal(mapped, port),
            in_hexadecimal(any, port)};
  }
  return {in_hexadecimal(words, port), in_hexadecimal(any, port)};
}

}  // namespace

Result<std::optional<uid_t>> udp_sender_user(const sockaddr_storage& from) {
  if (!is_of_this_host({&from, sizeof from})) return std::optional<uid_t>();
  const auto sought = local_addresses(from);
  std::optional<uid_t> user;
  for (const char* table : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream file(table);
    std::string line;
    std::getline(file, line);  // skip the column names
    while (std::getline(file, line)) {
      // sl local_address rem_address st tx:rx tr:when retrnsmt uid; source: man 5 proc.
      std::istringstream words(line);
      std::string word, local;
      uid_t owner = 0;
      words >> word >> local >> word >> word >> word >> word >> word >> owner;
      if (!words || std::find(sought.begin(), sought.end(), local) == sought.end()) continue;
      if (!user || *user == ::geteuid()) user = owner;
    }
  }
  if (!user) return Error{Code::NotFound, "no socket has its address"};
  return user;
}

}  // namespace hc
