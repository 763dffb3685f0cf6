// SPDX-License-Identifier: Apache-2.0
#include <graph/run/observation.h>

#include <unistd.h>

#include <hc/base/clock.h>
#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

constexpr std::chrono::milliseconds kSoon{20};
constexpr std::uint64_t kMostCommands = std::uint64_t{1} << 20;  // in one message [byte]

enum Sender : std::int32_t { State = 1, Log };

Message stamped(Message message, Sender src, std::int64_t& seq) {
  message.header.src = src;
  message.header.seq = seq++;
  message.header.time = SystemClock().wall();
  return message;
}

}  // namespace

Result<std::unique_ptr<Observation>> Observation::make(Loop& loop, const std::string& name,
                                                       Asked asked) {
  const std::string uri = "unix-listen:@hypercolumn." + name + "." + std::to_string(::getpid());
  std::unique_ptr<Observation> observation(new Observation(loop, std::move(asked)));
  auto& self = *observation;
  auto announcer =
      Announcer::make(loop, uri, [&self] { return std::vector{self.state_message()}; });
  if (!announcer) return announcer.error();
  self.announcer_ = std::move(*announcer);
  LinkOptions options;
  options.limits.element_bytes = kMostCommands;
  auto commands = Intake::make(
      loop, uri + ".ask", [&self](const Message& message) { self.take_commands(message); },
      options);
  if (!commands) return commands.error();
  self.commands_ = std::move(*commands);
  return observation;
}

Message Observation::state_message() {
  return stamped(make_rows(std::array{to_json(asked_.state())}), State, states_);
}

void Observation::publish_state() {
  if (!is_heard()) return;
  soon_.reset();
  announcer_->say(state_message());
}

void Observation::changed() {
  if (!is_heard() || soon_) return;
  soon_ = loop_.call_at(std::chrono::steady_clock::now() + kSoon, [this] { publish_state(); });
}

void Observation::log(const std::string& line) {
  if (is_heard() && !line.empty())
    announcer_->say(stamped(make_rows(std::array{line}), Log, lines_));
}

void Observation::take_commands(const Message& message) const {
  constexpr std::string_view kReply = "reply ", kObserve = "observe ", kDescribe = "describe ";
  auto commands = rows_of(message);
  std::string reply;
  if (!commands.empty() && commands.front().starts_with(kReply)) {
    reply = commands.front().substr(kReply.size());
    commands.erase(commands.begin());
  }
  auto say = [reply](const std::vector<std::string>& rows) {
    // Whoever has left meanwhile needs no answer.
    if (!reply.empty()) static_cast<void>(say_at_once(reply, make_rows(rows)));
  };
  auto answer = [say](const std::vector<std::string>& wrong) {
    say(wrong.empty() ? std::vector<std::string>{"ok"} : wrong);
  };
  if (commands.empty()) return answer({"there is no command"});
  auto say_found = [&](const Result<std::string>& found) {
    say(found ? std::vector<std::string>{"ok", *found}
              : std::vector<std::string>{found.error().detail});
  };
  const auto& first = commands.front();
  if (commands.size() == 1 && first.starts_with(kObserve))
    return say_found(asked_.observe(first.substr(kObserve.size())));
  if (commands.size() == 1 && first.starts_with(kDescribe))
    return say_found(asked_.describe(first.substr(kDescribe.size())));
  asked_.obey(commands, answer);
}

}  // namespace hc::internal
