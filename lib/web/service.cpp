// SPDX-License-Identifier: Apache-2.0
#include <web/service.h>

#include <hc/base/format.h>
#include <hc/base/words.h>
#include <web/identity.h>

namespace hc::web {

Result<std::unique_ptr<Service>> Service::open(const Listening& listening, Loop& loop,
                                               std::function<void(std::string_view)> log) {
  constexpr int kPorts = 10;
  std::string identity;
  if (listening.tls || !is_local(listening.address)) {
    auto loaded = load_identity(settings_folder());
    if (!loaded) return loaded.error();
    identity = std::move(*loaded);
  }
  auto server =
      Server::listen(listening.address == "localhost" ? "127.0.0.1" : listening.address,
                     static_cast<std::uint16_t>(listening.port), listening.port == 0 ? 1 : kPorts,
                     identity, [&loop, log](Level, std::string_view line) {
                       loop.post([log, kept = std::string(line)] { log(kept); });
                     });
  if (!server) return server.error();
  if (listening.port != 0 && (*server)->port() != listening.port)
    log(hc::format("port {} is in use; listening at port {}", listening.port, (*server)->port()));
  const auto hosts = words_of(listening.hosts, ", \t\n");
  Place place{
      listening.address, (*server)->port(), !identity.empty(), {hosts.begin(), hosts.end()}};
  return std::unique_ptr<Service>(
      new Service(std::move(*server), std::move(place), web::fingerprint(identity)));
}

void Service::run(std::unique_ptr<Site> site) {
  site_ = std::move(site);
  thread_ = std::thread([this] { server().run(*site_); });
}

Service::~Service() {
  if (!thread_.joinable()) return;
  server().stop();
  server().post([this] { site_->close(); });
  thread_.join();
}

}  // namespace hc::web
