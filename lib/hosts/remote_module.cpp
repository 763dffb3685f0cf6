// SPDX-License-Identifier: Apache-2.0
#include <hosts/remote_module.h>

#include <hosts/connection.h>

namespace hc::hosts {

RemoteModule::RemoteModule(std::shared_ptr<Connection> host, std::int64_t number,
                           std::string manage_uri, ModuleCallbacks callbacks)
    : host_(std::move(host)),
      number_(number),
      manage_uri_(std::move(manage_uri)),
      callbacks_(std::move(callbacks)) {
  host_->add(number_, *this);
}

RemoteModule::~RemoteModule() {
  send("kill");
  send("over");
  host_->remove(number_);
}

Status RemoteModule::start(const std::vector<std::string>& command,
                           const std::string& control_uri) {
  if (!host_->state().is_connected) return Error{Code::Closed, "its host is not connected"};
  runs_ = true;
  host_->send({{"what", "start"},
               {"number", number_},
               {"command", command},
               {"manage", manage_uri_},
               {"control", control_uri}});
  return {};
}

void RemoteModule::send(const char* what) const {
  host_->send({{"what", what}, {"number", number_}});
}

bool RemoteModule::send(const Message& command) {
  Message handed_on = command;
  handed_on.header.src = Commands;
  handed_on.header.dst = static_cast<std::int32_t>(number_);
  host_->say(handed_on);
  return true;
}

void RemoteModule::listens() {
  is_listening_ = runs_;
  for (const auto& command : callbacks_.listens()) send(command);
}

void RemoteModule::ended(int status) {
  if (!std::exchange(runs_, false)) return;
  is_listening_ = false;
  process_ = 0;
  usage_ = {};
  callbacks_.ended(status);
}

}  // namespace hc::hosts
