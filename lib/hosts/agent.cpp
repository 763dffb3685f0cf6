// SPDX-License-Identifier: Apache-2.0
#include <hosts/agent.h>

#include <fcntl.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>
#include <memory>
#include <sstream>

#include <graph/held_port.h>
#include <graph/log_limit.h>
#include <graph/module_process.h>
#include <graph/process.h>
#include <graph/programs.h>
#include <hc/os/aside.h>
#include <hosts/conversation.h>
#include <hosts/key_file.h>

namespace hc::hosts {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kTimeToEnd{1};
constexpr int kHeartbeatsPerUsage = 2, kUsagesPerMemory = 4;

/// A module that runs here, or will run again.
struct Child {
  std::unique_ptr<ModuleProcess> process;
  bool is_over = false;       // it will not be started again
  std::uint64_t dropped = 0;  // bytes of its log since the last that was sent
  LogLimit log_limit;
};

/// A question of the runner.
struct Question {
  std::int64_t id = 0;
  std::string what, subject;
};

class Agent {
 public:
  explicit Agent(const AgentOptions& options) : options_(options) {}

  Status run() {
    HC_TRY(begin());
    while (!is_over_) HC_TRY(loop_->turn());
    questions_.clear();
    return end_children();
  }

 private:
  Status begin() {
    loop_ = HC_TRY(Loop::make());
    for (int descriptor : {options_.in, options_.out})
      ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
    conversation_ = HC_TRY(Conversation::make(*loop_, options_.in, options_.out, kSilence,
                                              {[this](const Message& message) { take(message); },
                                               [this](const std::string& why) {
                                                 end(Error{Code::Closed, why});
                                               }}));
    const int stop = options_.stop;
    stop_ = HC_TRY(loop_->watch(stop, stop < 0 ? 0U : EPOLLIN, [this](auto) { end({}); }));
    Json hello = {{"what", "hello"}, {"version", options_.version}};
    // "CLIENT PORT SERVER PORT": addresses of the two hosts as seen from each other.
    const char* connection = std::getenv("SSH_CONNECTION");
    std::istringstream words(connection == nullptr ? "" : connection);
    std::string client, port, server;
    if (words >> client >> port >> server) hello.update({{"runner", client}, {"address", server}});
    send(hello);
    send_heartbeat();
    return {};
  }

  void end(Status outcome) {
    // The end of the runner is not a failure.
    if (!outcome && outcome.error().detail == Conversation::kEnded) outcome = {};
    outcome_ = std::move(outcome);
    is_over_ = true;
    conversation_->close();
    stop_.reset();
  }

  /// Gives modules kTimeToEnd to release their devices; the destructor kills the others.
  Status end_children() {
    for (auto& [number, child] : children_) child.process->ask_to_end();
    auto runs = [](const auto& entry) { return entry.second.process->runs(); };
    bool is_late = false;
    const auto timer = loop_->call_at(Clock::now() + kTimeToEnd, [&] { is_late = true; });
    while (std::ranges::any_of(children_, runs) && !is_late) HC_TRY(loop_->turn());
    return outcome_;
  }

  void send(const Json& order) { conversation_->send(make_order(order)); }

  void send_heartbeat() {
    if (++heartbeats_ % kHeartbeatsPerUsage == 0) send_usage();
    send_times({0, 0, monotonic_now().count(), monotonic_to_wall().count()});
    heartbeat_ = loop_->call_at(Clock::now() + kHeartbeat, [this] { send_heartbeat(); });
  }

  void send_times(const Moments& times) { send({{"what", "heartbeat"}, {"times", times}}); }

  void take(const Message& message) {
    const auto taken = monotonic_now();
    if (message.header.src == Order) return obey(read_order(message), taken);
    auto* process = message.header.src == Commands ? find(message.header.dst) : nullptr;
    if (process != nullptr) process->send(message);
  }

  ModuleProcess* find(std::int64_t number) {
    const auto found = children_.find(number);
    return found == children_.end() ? nullptr : found->second.process.get();
  }

  /// @param taken  arrival of the order on the monotonic clock.
  void obey(const Json& order, MonotonicTime taken) try {
    if (order.is_null()) return;
    const std::string what = order.at("what");
    const auto number = order.value("number", std::int64_t{0});
    auto* process = find(number);
    if (what == "heartbeat") {
      const auto times = order.at("times").get<Moments>();
      send_times({times[0], taken.count(), monotonic_now().count(), monotonic_to_wall().count()});
    } else if (what == "key") {
      auto key = make_key_file(order.at("key").get<std::string>());
      if (!key) return end(key.error());
      key_ = std::move(*key);
    } else if (what == "start") {
      start(number, order);
    } else if (what == "end") {
      if (process != nullptr) process->ask_to_end();
    } else if (what == "kill") {
      if (process != nullptr) process->kill();
    } else if (what == "over") {
      if (process != nullptr) children_.at(number).is_over = true;
      forget_if_over(number);
    } else if (what == "read") {
      auto reader = read_in_place_here(*loop_, order.at("uri"), key_.get());
      if (!reader) return end(reader.error());
      readers_[number] = std::move(*reader);
    } else if (what == "leave") {
      readers_.erase(number);
    } else if (what == "release") {
      ports_.erase(order.at("port").get<std::int64_t>());
    } else if (what == "hold") {
      hold(order);
    } else {
      questions_.push_back({id_of(order), what, order.value("subject", std::string())});
      answer_next();
    }
  } catch (const Json::exception& error) {
    end(Error{Code::Malformed, std::string("order: ") + error.what()});
  }

  void start(std::int64_t number, const Json& order) {
    auto started = start_child(number, order);
    if (started)
      send({{"what", "started"}, {"number", number}, {"process", find(number)->number()}});
    else
      send({{"what", "ended"},
            {"number", number},
            {"status", kCannotExecute},
            {"error", started.error().detail}});
  }

  Status start_child(std::int64_t number, const Json& order) {
    if (find(number) == nullptr) {
      ModuleCallbacks callbacks{
          [this, number](std::string_view bytes) { return forward_log(number, bytes); },
          [this, number](const Message& message) { report(number, message); },
          [this, number] {
            send({{"what", "listens"}, {"number", number}});
            return std::vector<Message>();
          },
          [this, number](int status) {
            send({{"what", "ended"}, {"number", number}, {"status", status}});
            // Deferred, since the child is the caller.
            loop_->post([this, number] { forget_if_over(number); });
          }};
      children_[number].process =
          HC_TRY(make_process_here(*loop_, order.at("manage"), key_.get(), std::move(callbacks)));
    }
    auto& child = children_.at(number);
    child.is_over = false;
    return child.process->start(order.at("command"), order.at("control"));
  }

  void forget_if_over(std::int64_t number) {
    const auto found = children_.find(number);
    if (found != children_.end() && found->second.is_over && !found->second.process->runs())
      children_.erase(found);
  }

  void report(std::int64_t number, const Message& message) {
    const bool is_counters = message.header.src <= 1;  // cumulative, so they may be dropped
    if (is_counters && conversation_->backlog() > kCrowded) return;
    if (message.header.src < 0 || message.header.src >= Report) return;
    Message forwarded = message;
    forwarded.header.src += Report;
    forwarded.header.dst = static_cast<std::int32_t>(number);
    conversation_->send(forwarded);
  }

  /// Forwards a piece of a module's log; drops and counts it above the limit.
  bool forward_log(std::int64_t number, std::string_view bytes) {
    auto& child = children_.at(number);
    const auto now = SystemClock().monotonic();
    static_cast<void>(child.log_limit.take_remark(now));
    const bool passes = child.log_limit.passes(bytes.size(), now);
    if (!passes || conversation_->backlog() > kCrowded) {
      child.dropped += bytes.size();
      return passes;
    }
    if (const auto dropped = std::exchange(child.dropped, 0); dropped > 0)
      conversation_->send(make_bytes(
          std::to_string(dropped) + " bytes of the log dropped: too much output\n", number));
    conversation_->send(make_bytes(bytes, number));
    return true;
  }

  void send_usage() {
    const bool with_memory = usages_++ % kUsagesPerMemory == 0;
    std::vector<UsageRow> rows;
    for (auto& [number, child] : children_) {
      if (!child.process->runs()) continue;
      const auto usage = child.process->usage(with_memory);
      rows.push_back({number, child.process->number(), usage.processor.count(),
                      static_cast<std::int64_t>(usage.memory), std::int64_t{usage.is_stopped},
                      std::int64_t{usage.is_traced}, usage.waited.count()});
    }
    if (!rows.empty()) send({{"what", "usage"}, {"modules", rows}});
  }

  /// Reserves a port; number 0: any.
  void hold(const Json& order) {
    auto port = hold_port(order.at("of_all"), order.at("port").get<std::uint16_t>());
    if (port) ports_[(*port)->number] = *port;
    send(answer_of(id_of(order), "port", port ? Result<Json>((*port)->number) : port.error()));
  }

  static std::int64_t id_of(const Json& order) { return order.value("id", std::int64_t{0}); }

  static Json answer_of(std::int64_t id, const char* key, const Result<Json>& value) {
    return {{"what", "answer"},
            {"id", id},
            {value ? key : "error", value ? *value : Json(value.error().detail)}};
  }

  /// Answers the next question on another thread, as the programs asked may be slow.
  void answer_next() {
    if (aside_.is_busy() || questions_.empty()) return;
    auto aside = run_aside(
        *loop_,
        [this, question = questions_.front()](int stop) {
          return answer_of(question.id, "text", answer_to(question, stop));
        },
        [this](const Json& answer) {
          send(answer);
          answer_next();
        });
    if (!aside) return end(aside.error());
    aside_ = std::move(*aside);
    questions_.pop_front();
  }

  [[nodiscard]] Result<Json> answer_to(const Question& question, int stop) const {
    const std::string& subject = question.subject;
    if (question.what == "describe") {
      auto description = HC_TRY(describe_program(subject, stop));
      return Json(std::move(description));
    }
    if (question.what == "examine" && options_.examine) return Json(options_.examine(subject));
    if (question.what != "find") return Error{Code::Invalid, "unknown question: " + question.what};
    return unless_stopped(stop, [subject]() -> Result<Json> {
      const auto program = find_program(subject);
      if (!program.empty()) return Json(program);
      return Error{Code::NotFound, no_program(subject)};
    });
  }

  const AgentOptions& options_;
  std::unique_ptr<Loop> loop_;
  Aside aside_;
  std::unique_ptr<Conversation> conversation_;
  Descriptor key_;
  std::map<std::int64_t, Child> children_;
  std::map<std::int64_t, std::shared_ptr<const HeldPort>> ports_;
  std::map<std::int64_t, std::shared_ptr<void>> readers_;  // replace ended modules
  std::deque<Question> questions_;
  int heartbeats_ = 0, usages_ = 0;
  bool is_over_ = false;
  Status outcome_;
  Loop::Handle stop_, heartbeat_;
};

}  // namespace

Status run_agent(const AgentOptions& options) {
  return Agent(options).run();
}

}  // namespace hc::hosts
