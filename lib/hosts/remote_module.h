// SPDX-License-Identifier: Apache-2.0
#pragma once
// The processes of a module on another host. Internal.

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <graph/module_process.h>
#include <hosts/connection.h>

namespace hc::hosts {

/// Runs the processes of a module on that host.
class RemoteModule final : public ModuleProcess {
 public:
  /// @param modules  the host's; lists this one while it exists.
  /// @param number  identifies the module in messages.
  RemoteModule(std::shared_ptr<Connection> host, std::map<std::int64_t, RemoteModule*>& modules,
               std::int64_t number, std::string manage_uri, ModuleCallbacks callbacks)
      : host_(std::move(host)),
        modules_(modules),
        number_(number),
        manage_uri_(std::move(manage_uri)),
        callbacks_(std::move(callbacks)) {
    modules_[number_] = this;
  }
  RemoteModule(const RemoteModule&) = delete;
  RemoteModule& operator=(const RemoteModule&) = delete;
  ~RemoteModule() override {
    send("kill");
    send("over");
    modules_.erase(number_);
  }

  Status start(const std::vector<std::string>& command, const std::string& control_uri) override {
    if (!host_->state().is_connected) return Error{Code::Closed, "its host is not connected"};
    runs_ = true;
    host_->send({{"what", "start"},
                 {"number", number_},
                 {"command", command},
                 {"manage", manage_uri_},
                 {"control", control_uri}});
    return {};
  }
  [[nodiscard]] bool runs() const override { return runs_; }
  void ask_to_end() override { send("end"); }
  void kill() override { send("kill"); }
  void check_end() override {}  // the agent reports it
  void release_names() override { send("over"); }
  [[nodiscard]] bool is_listening() const override { return is_listening_; }
  bool send(const Message& command) override {
    Message forwarded = command;
    forwarded.header.src = Commands;
    forwarded.header.dst = static_cast<std::int32_t>(number_);
    host_->forward(forwarded);
    return true;
  }
  [[nodiscard]] pid_t number() const override { return process_; }
  Usage usage(bool) override { return usage_; }

  // Events reported by the agent.

  void wrote(std::string_view bytes) const { callbacks_.wrote(bytes); }
  void reported(Message report) const {
    report.header.src -= Report;
    report.header.dst = 0;
    callbacks_.reported(report);
  }
  void obey(const std::string& what, const Json& order) {
    if (what == "started") process_ = order.at("process");
    if (what == "listens") {
      is_listening_ = runs_;
      for (const auto& command : callbacks_.connected()) send(command);
    }
    if (what != "ended") return;
    if (order.contains("error")) wrote(order.at("error").get<std::string>() + "\n");
    ended(std::clamp(order.at("status").get<int>(), 0, Host::kHostLost - 1));
  }
  void used(const UsageRow& row) {
    process_ = static_cast<pid_t>(row[1]);
    usage_ = {.processor = std::chrono::nanoseconds(row[2]),
              .waited = std::chrono::nanoseconds(row[6]),
              .memory = static_cast<std::uint64_t>(row[3]),
              .is_stopped = row[4] != 0,
              .is_traced = row[5] != 0};
  }
  void ended(int status) {
    if (!std::exchange(runs_, false)) return;
    is_listening_ = false;
    process_ = 0;
    usage_ = {};
    callbacks_.ended(status);
  }

 private:
  void send(const char* what) const { host_->send({{"what", what}, {"number", number_}}); }

  const std::shared_ptr<Connection> host_;
  std::map<std::int64_t, RemoteModule*>& modules_;
  const std::int64_t number_;
  const std::string manage_uri_;
  const ModuleCallbacks callbacks_;
  bool runs_ = false, is_listening_ = false;
  pid_t process_ = 0;
  Usage usage_;
};

}  // namespace hc::hosts
