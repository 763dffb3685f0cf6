// SPDX-License-Identifier: Apache-2.0
#pragma once
// The connection to one host over ssh: its agent, and the modules it runs. Internal.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <hc/base/backoff.h>
#include <hosts/answer.h>
#include <hosts/clock_estimate.h>
#include <hosts/ssh.h>

namespace hc::hosts {

class RemoteModule;

/// The connection to a host; reconnects when it is lost. Used on the thread of a loop, except for
/// the functions of Host for planning.
class Connection final : public Host, public std::enable_shared_from_this<Connection> {
 public:
  struct Parts {
    GraphHost declared;
    std::string version;
    std::string key, fingerprint;  ///< of that host; the key in PEM
    std::function<void(const std::string& line)> log;
    std::function<void()> changed;
  };

  Connection(Loop& loop, Parts parts) : loop_(loop), parts_(std::move(parts)) {
    state_.name = parts_.declared.name;
  }

  /// Connects for the first time, without retries.
  /// @param opened  gets the outcome. Errors: Closed.
  void open(std::function<void(Status)> opened) {
    opened_ = std::move(opened);
    connect();
  }
  void close();

  [[nodiscard]] bool is_of(const GraphHost& declared) const;

  /// Sends to the agent, if connected.
  void send(const Json& order) { forward(make_order(order)); }
  void forward(const Message& message) {
    if (ssh_) ssh_->send(message);
  }

  Result<std::string> find_program(const std::string& name, int stop) override {
    return ask_text("find", name, stop);
  }
  Result<std::string> describe_program(const std::string& program, int stop) override {
    return ask_text("describe", program, stop);
  }
  Result<std::string> examine(const std::string& question, int stop) override {
    return ask_text("examine", question, stop);
  }
  Result<std::shared_ptr<const HeldPort>> hold_port(bool of_all_addresses, int stop) override;
  [[nodiscard]] HostPlace place() const override { return place_; }
  [[nodiscard]] HostState state() const override { return state_; }
  std::unique_ptr<ModuleProcess> make_process(const PlannedModule& module,
                                              ModuleCallbacks callbacks) override;
  std::shared_ptr<void> read_in_place(const std::string& reader_uri) override;
  Result<std::shared_ptr<const HeldPort>> spare_port() override;
  [[nodiscard]] std::chrono::nanoseconds wall_offset() const override { return wall_offset_; }

 private:
  using Answered = std::function<void(Result<Json>)>;

  void ask(Json question, Answered answered);
  /// Reserves a port there; number 0: any.
  void ask_for_port(bool of_all, std::uint16_t number, Give<std::uint16_t> give);
  Result<std::string> ask_text(const char* what, const std::string& subject, int stop);
  std::shared_ptr<const HeldPort> held(std::uint16_t number, bool of_all);

  void connect();
  void take(const Message& message);
  void obey(const Json& order, MonotonicTime received);
  void greet(const Json& hello);
  void take_times(const Moments& times, MonotonicTime received);
  void finish_connecting();
  void check_clock(std::chrono::nanoseconds there_to_wall);
  void ask_for_spare();
  void ask_time();
  void send_heartbeat();
  void lose(const std::string& why);
  void disconnect();

  Loop& loop_;
  const Parts parts_;
  std::function<void(Status)> opened_;  // of the first attempt
  bool is_closed_ = false;
  HostState state_;
  HostPlace place_;

  // While ssh runs:
  std::unique_ptr<Ssh> ssh_;
  Loop::Handle heartbeat_, again_;
  Backoff pause_{std::chrono::milliseconds(100), std::chrono::seconds(5)};
  std::chrono::steady_clock::time_point connected_, greeted_;
  int first_exchanges_ = 0;  // of timestamps, before it counts as connected
  ClockEstimate estimate_;
  std::optional<std::chrono::nanoseconds> there_to_wall_;
  std::chrono::nanoseconds wall_offset_{0};
  std::vector<std::uint16_t> spares_;

  std::int64_t last_question_ = 0, last_number_ = 0;
  std::map<std::int64_t, Answered> questions_;
  std::map<std::string, Json> answers_;  // to questions of ask_text()
  std::map<std::int64_t, RemoteModule*> modules_;
  std::map<std::int64_t, std::string> readers_;  // URIs of readers that replace ended modules
  std::map<std::uint16_t, bool> ports_;          // reserved; true: of all addresses
};

}  // namespace hc::hosts
