// SPDX-License-Identifier: Apache-2.0
#pragma once
// One other host: ssh to it, its agent, and what runs there. Internal.

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/run/process.h>
#include <hc/os/wait_readable.h>
#include <hosts/clock_estimate.h>
#include <hosts/conversation.h>
#include <hosts/remote_module.h>
#include <hosts/worker.h>

namespace hc::hosts {

/// A host as the graph has it. Its conversation is on the worker's thread; the connection is made
/// again whenever it is lost.
class Connection final : public Host, public std::enable_shared_from_this<Connection> {
 public:
  struct Parts {
    GraphHost declared;
    std::string version;
    std::string key, fingerprint;                      ///< of that host: PEM
    std::function<void(const std::string& line)> log;  ///< from the worker's thread
    std::function<void()> changed;                     ///< the same
  };

  Connection(Worker& worker, Parts parts) : worker_(worker), parts_(std::move(parts)) {
    state_.name = parts_.declared.name;
  }

  /// Connects for the first time; a failure is the end of it.
  void open();
  /// What came of that. Errors: Closed, Stopped.
  Status wait_until_open(int stop);
  /// Ends all there is.
  void close();

  [[nodiscard]] bool is_of(const GraphHost& declared) const;

  Result<std::string> find_program(const std::string& name, int stop) override;
  Result<std::string> describe_program(const std::string& program, int stop) override;
  Result<std::string> examine(const std::string& question, int stop) override;
  Result<std::shared_ptr<const internal::HeldPort>> hold_port(bool of_all_addresses,
                                                              int stop) override;
  [[nodiscard]] HostPlace place() const override;
  [[nodiscard]] HostState state() const override;
  std::unique_ptr<internal::ModuleProcess> start(const PlannedModule& module) override;
  void let_go(const PlannedModule& module) override {
    send({{"what", "over"}, {"manage", module.manage_uri}});
  }
  std::shared_ptr<void> read_in_place(const std::string& reader_uri) override;
  Result<std::shared_ptr<const internal::HeldPort>> spare_port() override;
  [[nodiscard]] std::int64_t wall_offset() const override;

  /// Sends an order to the agent, if it is connected. From any thread.
  void send(Json order);

 private:
  class Process;
  /// That somebody on another thread waits for.
  class Answer {
   public:
    explicit Answer(Result<internal::Event> event) {
      if (event)
        event_ = std::move(*event);
      else
        value_ = event.error();
    }
    void give(Result<Json> value) {
      const std::lock_guard lock(mutex_);
      value_ = std::move(value);
      event_.raise();
    }
    Result<Json> wait(int stop, std::chrono::milliseconds timeout) const {
      if (event_.descriptor() < 0) return value_;
      const std::array<int, 1> wanted = {event_.descriptor()};
      auto ready = wait_readable(wanted, stop, timeout);
      if (!ready) return ready.error();
      const std::lock_guard lock(mutex_);
      return value_;
    }

   private:
    internal::Event event_;  // none where there was no descriptor for it
    mutable std::mutex mutex_;
    Result<Json> value_ = Error{Code::Closed, "no answer for 30 s"};
  };

  Result<Json> ask(Json question, int stop);
  Result<std::string> ask_text(const char* what, const std::string& subject, int stop);
  std::shared_ptr<const internal::HeldPort> held(std::uint16_t number, bool of_all_addresses);

  // On the worker's thread.
  void connect();
  void read_ssh_errors();
  void take(const Message& message);
  void obey(const Json& order);
  void greet(const Json& hello);
  void hold_again();
  void want_spare();
  void take_heartbeat(const Message& message, std::int64_t received);
  void look_at_clock(std::int64_t there_to_wall);
  void take_usage(const Message& message);
  void ask_time();
  void send_heartbeat();
  void lose(const std::string& why);
  [[nodiscard]] std::string reason_of(const std::string& noticed) const;
  void disconnect();

  Worker& worker_;
  const Parts parts_;
  std::shared_ptr<Answer> first_ =
      std::make_shared<Answer>(internal::Event::make());  // whether it has been connected

  // On the worker's thread.
  std::optional<internal::Process> ssh_;
  std::unique_ptr<Conversation> conversation_;
  internal::Loop::Handle ssh_errors_, heartbeat_, again_;
  std::string error_text_;  // what ssh has written to its standard error
  bool is_greeted_ = false, is_open_ = false, is_closed_ = false;
  std::chrono::milliseconds delay_{0};  // before it is tried again
  std::chrono::steady_clock::time_point connected_, greeted_;
  int first_exchanges_ = 0;  // of the clock
  std::int64_t asked_ = 0;
  std::map<std::int64_t, std::function<void(Result<Json>)>> questions_;
  std::map<std::int64_t, std::shared_ptr<RemoteModule>> modules_;
  std::map<std::int64_t, std::string> readers_;  // in place of those that are over
  std::map<std::uint16_t, bool> ports_;          // and whether they are of all addresses
  bool is_first_ = true;                         // nothing has come of the first time yet
  ClockEstimate estimate_;
  std::optional<std::int64_t> there_to_wall_;

  mutable std::mutex mutex_;  // of the rest
  HostState state_;
  HostPlace place_;
  std::int64_t wall_offset_ = 0;
  std::vector<std::uint16_t> spares_;
  std::map<std::pair<std::string, std::string>, std::string> answers_;  ///< to ask_text()
  std::int64_t numbered_ = 0;
};

}  // namespace hc::hosts
