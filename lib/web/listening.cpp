// SPDX-License-Identifier: Apache-2.0
#include <web/listening.h>

#include <optional>
#include <utility>
#include <vector>

#include <web/identity.h>

namespace hc::web {
namespace {

constexpr int kPorts = 10;

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c != ',' && c != ' ')
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

}  // namespace

bool is_local(const std::string& address) {
  return address == "127.0.0.1" || address == "::1" || address == "localhost";
}

Result<Opened> open_server(const Listening& listening, LogSink log) {
  Opened opened;
  std::optional<Identity> identity;
  if (listening.tls || !is_local(listening.address)) {
    auto loaded = load_identity(settings_folder());
    if (!loaded) return loaded.error();
    identity = std::move(*loaded);
    auto known = fingerprint(identity->certificate);
    if (!known) return known.error();
    opened.fingerprint = std::move(*known);
  }
  auto server =
      Server::listen(listening.address == "localhost" ? "127.0.0.1" : listening.address,
                     static_cast<std::uint16_t>(listening.port), listening.port == 0 ? 1 : kPorts,
                     identity ? &*identity : nullptr, std::move(log));
  if (!server) return server.error();
  opened.server = std::move(*server);
  opened.place = {listening.address, opened.server->port(), identity.has_value(),
                  words_of(listening.hosts)};
  return opened;
}

}  // namespace hc::web
