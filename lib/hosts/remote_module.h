// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs the processes of a module on another host. Internal.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <graph/module_process.h>

namespace hc::hosts {

class Connection;

class RemoteModule final : public ModuleProcess {
 public:
  /// @param number  the module's number in the conversation.
  RemoteModule(std::shared_ptr<Connection> host, std::int64_t number, std::string manage_uri,
               ModuleCallbacks callbacks);
  ~RemoteModule() override;

  Status start(const std::vector<std::string>& command, const std::string& control_uri) override;
  [[nodiscard]] bool runs() const override { return runs_; }
  void ask_to_end() override { send("end"); }
  void kill() override { send("kill"); }
  void look() override {}  // its end comes over the connection
  void let_names_go() override { send("over"); }
  [[nodiscard]] bool is_listening() const override { return is_listening_; }
  bool send(const Message& command) override;
  [[nodiscard]] pid_t number() const override { return process_; }
  internal::Usage usage(bool) override { return usage_; }

  // For Connection: events that the agent reports.

  void said(std::string_view bytes) const { callbacks_.said(bytes); }
  void reported(const Message& report) const { callbacks_.reported(report); }
  void listens();
  void started(pid_t process) { process_ = process; }
  void used(const internal::Usage& usage) { usage_ = usage; }
  void ended(int status);

 private:
  void send(const char* what) const;

  const std::shared_ptr<Connection> host_;
  const std::int64_t number_;
  const std::string manage_uri_;
  const ModuleCallbacks callbacks_;
  bool runs_ = false, is_listening_ = false;
  pid_t process_ = 0;
  internal::Usage usage_;
};

}  // namespace hc::hosts
