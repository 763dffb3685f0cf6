// SPDX-License-Identifier: Apache-2.0
#include <web/service.h>

namespace hc::web {

Result<std::unique_ptr<Service>> Service::open(const Listening& listening, internal::Loop& loop,
                                               std::function<void(std::string_view)> log) {
  auto opened = open_server(listening, [&loop, log = std::move(log)](Level, std::string_view line) {
    loop.post([log, kept = std::string(line)] { log(kept); });
  });
  if (!opened) return opened.error();
  return std::unique_ptr<Service>(new Service(std::move(*opened)));
}

void Service::run(std::unique_ptr<Site> site) {
  site_ = std::move(site);
  thread_ = std::thread([this] { server().run(*site_); });
}

Service::~Service() {
  if (!thread_.joinable()) return;
  server().post([this] { site_->close(); });
  server().stop();
  thread_.join();
}

}  // namespace hc::web
