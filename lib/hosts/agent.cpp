// SPDX-License-Identifier: Apache-2.0
#include <hosts/agent.h>

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <deque>
#include <map>
#include <memory>
#include <sstream>

#include <graph/held_port.h>
#include <graph/plan.h>
#include <graph/programs.h>
#include <graph/run/announcer.h>
#include <graph/run/drain.h>
#include <graph/run/held_names.h>
#include <graph/run/log_limit.h>
#include <graph/run/process.h>
#include <hc/base/suggestion.h>
#include <hc/os/procfs.h>
#include <hc/os/program.h>
#include <hosts/conversation.h>
#include <hosts/key_file.h>

namespace hc::hosts {
namespace {

using internal::Announcer;
using internal::Aside;
using internal::Intake;
using internal::Loop;
using internal::Process;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kPiece = std::size_t{64} << 10;  // a pipe holds as much
constexpr int kLastPieces = 16;
constexpr std::chrono::seconds kTimeToEnd{1};
constexpr std::uint64_t kMostReported = std::uint64_t{1} << 20;  // in one message [byte]
constexpr int kHeartbeatsOfUsage = 2, kUsagesOfMemory = 4;

/// Where a module is met, by the readers of its outputs and by us: the same for all its processes,
/// and held between them, so that no other user takes a name.
struct Place {
  internal::HeldNames names;
  std::unique_ptr<Intake> reports;
  std::unique_ptr<Announcer> commands;
  std::int64_t child = 0;  // the process there now; 0: none
  bool is_over = false;    // none will follow
};

/// A module that runs here.
struct Child {
  explicit Child(Process started) : process(std::move(started)) {}

  std::string place;
  Process process;
  std::uint64_t unsaid = 0;  // bytes of its log that were dropped
  internal::LogLimit log_limit;
  std::vector<pid_t> processes;
  std::uint64_t memory = 0;
  Loop::Handle said, ended;
};

class Agent {
 public:
  explicit Agent(const AgentOptions& options) : options_(options) {}

  Status run() {
    if (auto begun = begin(); !begun) return begun.error();
    while (!is_over_)
      if (auto turned = loop_->turn(); !turned) return turned.error();
    questions_.clear();
    return end_children();
  }

 private:
  Status begin() {
    auto loop = Loop::make();
    if (!loop) return loop.error();
    loop_ = std::move(*loop);
    for (int descriptor : {options_.in, options_.out})
      ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
    auto conversation = Conversation::make(*loop_, options_.in, options_.out, kSilence,
                                           {[this](const Message& message) { take(message); },
                                            [this](const std::string& why) {
                                              end(Error{Code::Closed, why});
                                            }});
    if (!conversation) return conversation.error();
    conversation_ = std::move(*conversation);
    if (options_.stop >= 0) {
      auto watched = loop_->watch(options_.stop, EPOLLIN, [this](auto) { end({}); });
      if (!watched) return watched.error();
      stop_ = std::move(*watched);
    }
    Json hello = {{"what", "hello"}, {"version", options_.version}};
    // "CLIENT PORT SERVER PORT": the two hosts as they see each other.
    const char* connection = std::getenv("SSH_CONNECTION");
    std::istringstream words(connection == nullptr ? "" : connection);
    std::string client, port, server;
    if (words >> client >> port >> server) hello.update({{"runner", client}, {"address", server}});
    send(hello);
    send_heartbeat();
    return {};
  }

  void end(Status outcome) {
    // That who started this one has ended is no failure.
    if (!outcome && outcome.error().detail == Conversation::kEnded) outcome = {};
    outcome_ = std::move(outcome);
    is_over_ = true;
    conversation_->close();
    stop_.reset();
  }

  /// Gives modules a moment to leave their devices in order; those that have not ended then are
  /// killed with this object.
  Status end_children() {
    for (auto& [number, child] : children_) child->process.ask_to_end();
    bool is_late = false;
    const auto timer = loop_->call_at(Clock::now() + kTimeToEnd, [&] { is_late = true; });
    while (!children_.empty() && !is_late)
      if (auto turned = loop_->turn(); !turned) return turned.error();
    return outcome_;
  }

  void send(const Json& order) { conversation_->say(make_order(order)); }

  /// Speaks from time to time, so that the other end knows that this one is there.
  void send_heartbeat() {
    if (++heartbeats_ % kHeartbeatsOfUsage == 0) send_usage();
    const Moments moments{0, 0, monotonic_now(), monotonic_to_wall()};
    conversation_->say(make_numbers(Heartbeat, moments, moments.size()));
    heartbeat_ = loop_->call_at(Clock::now() + kHeartbeat, [this] { send_heartbeat(); });
  }

  void take(const Message& message) {
    const auto taken = monotonic_now();
    switch (message.header.src) {
      case Order:
        return obey(read_order(message));
      case Heartbeat: {
        const auto moments = read_numbers(message, Moments().size());
        if (moments.size() != Moments().size()) return;
        const Moments answer = {moments[0], taken, monotonic_now(), monotonic_to_wall()};
        return conversation_->say(make_numbers(Heartbeat, answer, answer.size()));
      }
      case Commands:
        if (auto* child = find(message.header.dst); child != nullptr)
          if (auto& commands = places_[child->place].commands) commands->say(message);
        return;
      default:
        return;
    }
  }

  Child* find(std::int64_t number) {
    auto found = children_.find(number);
    return found == children_.end() ? nullptr : found->second.get();
  }

  void obey(const Json& order) try {
    if (order.is_null()) return;
    const std::string what = order.at("what");
    if (what == "key") {
      auto key = make_key_file(order.at("key").get<std::string>());
      if (!key) return end(key.error());
      key_ = std::move(*key);
    } else if (what == "start") {
      start(order);
    } else if (what == "end") {
      if (auto* child = find(order.at("number"))) child->process.ask_to_end();
    } else if (what == "kill") {
      if (auto* child = find(order.at("number"))) child->process.kill();
    } else if (what == "read") {
      auto reader = internal::make_drain(*loop_, with_key(order.at("uri")));
      if (!reader) return end(reader.error());
      readers_[order.at("number")] = std::move(*reader);
    } else if (what == "leave") {
      readers_.erase(order.at("number").get<std::int64_t>());
    } else if (what == "over") {
      end_place(order.at("manage"), true);
    } else if (what == "release") {
      ports_.erase(order.at("port").get<std::int64_t>());
    } else if (what == "hold") {
      hold(order);
    } else {
      questions_.push_back(order);
      answer_next();
    }
  } catch (const Json::exception& error) {
    end(Error{Code::Malformed, std::string("an order: ") + error.what()});
  }

  /// Modules find the key at another descriptor.
  [[nodiscard]] std::string with_key(std::string uri) const {
    if (const auto at = uri.find(kKeyFile); at != std::string::npos)
      uri.replace(at, kKeyFile.size(), "/proc/self/fd/" + std::to_string(key_.get()));
    return uri;
  }

  void start(const Json& order) {
    const std::int64_t number = order.at("number");
    auto started = make_child(number, order);
    if (started) return;
    if (const auto* child = find(number)) end_place(child->place, false);
    children_.erase(number);
    send({{"what", "ended"},
          {"number", number},
          {"status", internal::kCannotExecute},
          {"error", started.error().detail}});
  }

  /// Listens where a module is met, unless that is done already. All before it starts.
  Status make_place(const std::string& manage, const std::string& control,
                    const std::vector<std::string>& command) {
    auto& place = places_[manage];
    place.is_over = false;
    if (!place.reports) {
      LinkOptions options;
      options.limits.element_bytes = kMostReported;
      auto reports = Intake::make(
          *loop_, manage, [this, &place](const Message& message) { report(place.child, message); },
          options);
      if (!reports) return reports.error();
      place.reports = std::move(*reports);
    }
    if (control.empty()) place.commands.reset();
    if (!control.empty() && !place.commands) {
      auto made = Announcer::make(*loop_, control, [this, &place] {
        if (place.child != 0) send({{"what", "listens"}, {"number", place.child}});
        return std::vector<Message>();
      });
      if (!made) return made.error();
      place.commands = std::move(*made);
    }
    return place.names.hold(command);
  }

  /// There is no process any more, or none will follow.
  void end_place(const std::string& manage, bool is_over) {
    const auto found = places_.find(manage);
    if (found == places_.end()) return;
    auto& place = found->second;
    place.is_over = place.is_over || is_over;
    if (!is_over) place.child = 0;
    if (place.child == 0 && place.commands) place.commands->leave_all();
    if (place.child == 0 && place.is_over) places_.erase(found);
  }

  Status make_child(std::int64_t number, const Json& order) {
    const auto manage = order.at("manage").get<std::string>();
    const auto command = order.at("command").get<std::vector<std::string>>();
    if (auto made = make_place(manage, order.at("control"), command); !made) return made;
    auto& place = places_[manage];
    auto process =
        Process::start(command, Process::Capture::Errors, {key_.get(), place.names.descriptors()});
    if (!process) return process.error();
    auto& child = *(children_[number] = std::make_unique<Child>(std::move(*process)));
    child.place = manage;
    place.child = number;
    auto said = loop_->watch(child.process.output(), EPOLLIN,
                             [this, number](auto) { pass_on_log(number); });
    if (!said) return said.error();
    child.said = std::move(*said);
    auto ended =
        loop_->watch(child.process.ended(), EPOLLIN, [this, number](auto) { note_end(number); });
    if (!ended) return ended.error();
    child.ended = std::move(*ended);
    send({{"what", "started"},
          {"number", number},
          {"process", internal::first_child(child.process.guard_number())}});
    return {};
  }

  void report(std::int64_t number, const Message& message) {
    if (number == 0) return;
    const bool is_counters = message.header.src <= 1;  // the next ones say the same and more
    if (is_counters && conversation_->backlog() > kCrowded) return;
    if (message.header.src < 0 || message.header.src >= Report) return;
    Message handed_on = message;
    handed_on.header.src += Report;
    handed_on.header.dst = static_cast<std::int32_t>(number);
    conversation_->say(handed_on);
  }

  /// Hands on a piece of what a module writes; what there is no room for is dropped, and counted.
  void pass_on_log(std::int64_t number) {
    static std::array<char, kPiece> piece;
    auto& child = *children_.at(number);
    static_cast<void>(child.said.want(EPOLLIN));
    const ssize_t size = ::read(child.process.output(), piece.data(), piece.size());
    if (size == 0) child.said.reset();
    if (size <= 0) return;
    const auto now = SystemClock().monotonic();
    static_cast<void>(child.log_limit.take_remark(now));
    const bool passes = child.log_limit.passes(static_cast<std::uint64_t>(size), now);
    if (!passes) {  // who floods its log waits for us
      static_cast<void>(child.said.want(0));
      child.said.call_at(Clock::now() + internal::LogLimit::kPause);
    }
    if (!passes || conversation_->backlog() > kCrowded) {
      child.unsaid += static_cast<std::uint64_t>(size);
      return;
    }
    if (const auto unsaid = std::exchange(child.unsaid, 0); unsaid > 0)
      conversation_->say(
          make_bytes(std::to_string(unsaid) + " bytes of the log dropped: too many\n", number));
    conversation_->say(make_bytes({piece.data(), static_cast<std::size_t>(size)}, number));
  }

  void note_end(std::int64_t number) {
    auto& child = *children_.at(number);
    const auto status = child.process.poll_status();
    if (!status) return;
    auto& reports = *places_[child.place].reports;
    reports.take();  // accepts a connection that has just been made,
    reports.take();  // and reads what came on it
    for (int i = 0; i < kLastPieces && child.said; ++i) pass_on_log(number);
    send({{"what", "ended"}, {"number", number}, {"status", *status}});
    end_place(child.place, false);
    children_.erase(number);
  }

  void send_usage() {
    const bool with_memory = usages_++ % kUsagesOfMemory == 0;
    std::vector<std::int64_t> numbers;
    for (auto& [number, child] : children_) {
      const bool is_new = child->processes.empty();
      if (with_memory || is_new)
        child->processes = internal::descendants(child->process.guard_number());
      const auto usage = internal::usage_of(child->processes, with_memory || is_new);
      if (with_memory || is_new) child->memory = usage.memory;
      for (const std::int64_t each :
           {number, std::int64_t{internal::first_child(child->process.guard_number())},
            std::int64_t{usage.processor.count()}, static_cast<std::int64_t>(child->memory),
            std::int64_t{usage.is_stopped}})
        numbers.push_back(each);
    }
    constexpr std::size_t kColumns = 5;
    if (!numbers.empty()) conversation_->say(make_numbers(Usage, numbers, kColumns));
  }

  /// Holds a port, of a number if one is given.
  void hold(const Json& order) {
    Json answer = {{"what", "answer"}, {"id", order.at("id")}};
    auto port = internal::hold_port(order.at("of_all"), order.at("port").get<std::uint16_t>());
    if (port) {
      answer["port"] = (*port)->number;
      ports_[(*port)->number] = *port;
    } else {
      answer["error"] = port.error().detail;
    }
    send(answer);
  }

  /// Answers a question on another thread, since programs that are asked may be slow.
  void answer_next() {
    if (aside_.is_busy() || questions_.empty()) return;
    auto aside = internal::run_aside(
        *loop_,
        [this, question = questions_.front()](int stop) { return answer_to(question, stop); },
        [this](const Json& answer) {
          send(answer);
          answer_next();
        });
    if (!aside) return end(aside.error());
    aside_ = std::move(*aside);
    questions_.pop_front();
  }

  [[nodiscard]] Json answer_to(const Json& question, int stop) const {
    Json answer = {{"what", "answer"}, {"id", question.value("id", 0)}};
    const std::string what = question.at("what"), subject = question.value("subject", "");
    if (what == "find") {
      const auto program = find_program(subject);
      if (program.empty())
        answer["error"] = "no program \"" + subject + "\"" + suggestion(subject, module_names());
      answer["text"] = program;
    } else if (what == "describe") {
      auto text = describe_program(subject, stop);
      if (text)
        answer["text"] = *text;
      else
        answer["error"] = text.error().detail;
    } else if (what == "examine" && options_.examine) {
      answer["text"] = options_.examine(subject);
    } else {
      answer["error"] = "no such question: " + what;
    }
    return answer;
  }

  const AgentOptions& options_;
  std::unique_ptr<Loop> loop_;
  Aside aside_;
  std::unique_ptr<Conversation> conversation_;
  internal::Descriptor key_;
  std::map<std::string, Place> places_;  // by where the module reports
  std::map<std::int64_t, std::unique_ptr<Child>> children_;
  std::map<std::int64_t, std::shared_ptr<const internal::HeldPort>> ports_;
  std::map<std::int64_t, std::unique_ptr<Intake>> readers_;
  std::deque<Json> questions_;
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
