// SPDX-License-Identifier: Apache-2.0
#include <hosts/connection.h>

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <graph/held_port.h>
#include <hc/base/clock.h>
#include <hc/base/format.h>
#include <hosts/remote_module.h>

namespace hc::hosts {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kAnswerTime{30000};
constexpr std::chrono::seconds kLasting{10};  // a connection of this length resets the backoff
constexpr int kFirstExchanges = 8;            // of timestamps, or as many as
constexpr milliseconds kLongestFirst{300};    // take no longer
constexpr std::size_t kSpares = 4;

/// An address reported by the agent; empty if links cannot use it, such as a link-local one.
std::string address_in(const Json& hello, const char* key) {
  const std::string text = hello.value(key, "127.0.0.1");  // without SSH_CONNECTION
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const bool is_address = ::inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
                          ::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
  return is_address ? text : "";
}

Error not_connected() {
  return {Code::Closed, "not connected"};
}

}  // namespace

bool Connection::is_of(const GraphHost& declared) const {
  auto words = [](const GraphHost& host) {
    std::vector<std::string> list = {host.program.value, host.address.value};
    for (const auto& word : host.ssh) list.push_back(word.value);
    return list;
  };
  return words(declared) == words(parts_.declared);
}

void Connection::close() {
  is_closed_ = true;
  if (ssh_) lose("closed");
  again_.reset();
  disconnect();
}

void Connection::ask(Json question, Answered answered) {
  if (!state_.is_connected) return answered(not_connected());
  question["id"] = ++last_question_;
  questions_[last_question_] = std::move(answered);
  send(question);
}

// For planning, on other threads.

Result<std::string> Connection::ask_text(const char* what, const std::string& subject, int stop) {
  const Json question = {{"what", what}, {"subject", subject}};
  const Json answer = HC_TRY(answer_of<Json>(
      loop_, stop, kAnswerTime, [self = shared_from_this(), question](const auto& give) {
        self->ask(question, [self, question, give](Result<Json> answered) {
          auto& known = self->answers_[question.dump()];
          if (answered) known = *answered;
          // While the host is disconnected, the last answer lets the rest of the graph be changed.
          if (!answered && answered.error().code == Code::Closed && !known.is_null())
            answered = known;
          give(std::move(answered));
        });
      }));
  const auto text = answer.find("text");
  if (text == answer.end() || !text->is_string())
    return Error{Code::Malformed, "agent: answer without text"};
  return text->get<std::string>();
}

Result<std::shared_ptr<const HeldPort>> Connection::hold_port(bool of_all_addresses, int stop) {
  return answer_of<std::shared_ptr<const HeldPort>>(
      loop_, stop, kAnswerTime, [self = shared_from_this(), of_all_addresses](const auto& give) {
        self->ask_for_port(
            of_all_addresses, 0, [self, of_all_addresses, give](const Result<std::uint16_t>& port) {
              give(port ? Result(self->held(*port, of_all_addresses)) : port.error());
            });
      });
}

// On the loop's thread.

void Connection::ask_for_port(bool of_all, std::uint16_t number, Give<std::uint16_t> give) {
  ask({{"what", "hold"}, {"of_all", of_all}, {"port", number}},
      [give = std::move(give)](const Result<Json>& answer) {
        const auto port = answer ? answer->value("port", 0U) : 0U;
        if (!answer) return give(answer.error());
        if (port == 0 || port > UINT16_MAX)
          return give(Error{Code::Malformed, "agent: answer without a port"});
        give(static_cast<std::uint16_t>(port));
      });
}

/// A reserved port; its last owner releases it, on any thread.
std::shared_ptr<const HeldPort> Connection::held(std::uint16_t number, bool of_all) {
  ports_[number] = of_all;
  return {new HeldPort{Descriptor(), number}, [host = weak_from_this()](const HeldPort* port) {
            if (auto self = host.lock())
              self->loop_.post([self, held = port->number] {
                self->ports_.erase(held);
                self->send({{"what", "release"}, {"port", held}});
              });
            delete port;
          }};
}

Result<std::shared_ptr<const HeldPort>> Connection::spare_port() {
  if (spares_.empty()) return not_connected();
  const auto number = spares_.back();
  spares_.pop_back();
  ask_for_spare();
  return held(number, true);
}

std::unique_ptr<ModuleProcess> Connection::make_process(const PlannedModule& module,
                                                        ModuleCallbacks callbacks) {
  return std::make_unique<RemoteModule>(shared_from_this(), modules_, ++last_number_,
                                        module.manage_uri, std::move(callbacks));
}

std::shared_ptr<void> Connection::read_in_place(const std::string& reader_uri) {
  const auto number = ++last_number_;
  readers_[number] = reader_uri;
  send({{"what", "read"}, {"number", number}, {"uri", reader_uri}});
  // The pointer itself is not used, only its deleter.
  return {this, [host = weak_from_this(), number](void*) {
            auto self = host.lock();
            if (!self) return;
            self->readers_.erase(number);
            self->send({{"what", "leave"}, {"number", number}});
          }};
}

void Connection::connect() {
  disconnect();
  auto ssh = Ssh::start(loop_, parts_.declared,
                        {[this](const Message& message) { take(message); },
                         [this](const std::string& why) { lose(why); }});
  if (!ssh) return lose(ssh.error().detail);
  ssh_ = std::move(*ssh);
}

void Connection::take(const Message& message) {
  const auto received = monotonic_now();
  const auto& header = message.header;
  if (header.src == Order) return obey(read_order(message), received);
  const auto found = modules_.find(header.dst);
  if (found == modules_.end()) return;
  if (header.src == Log) found->second->wrote(message.text());
  if (header.src >= Report) found->second->reported(message);
}

void Connection::obey(const Json& order, MonotonicTime received) try {
  if (order.is_null()) return;
  const std::string what = order.at("what");
  if (what == "hello") return greet(order);
  if (what == "heartbeat") return take_times(order.at("times").get<Moments>(), received);
  if (what == "usage")
    for (const auto& row : order.at("modules").get<std::vector<UsageRow>>())
      if (const auto found = modules_.find(row[0]); found != modules_.end())
        found->second->used(row);
  if (what == "answer") {
    auto found = questions_.find(order.at("id"));
    if (found == questions_.end()) return;
    const auto answer = std::move(found->second);
    questions_.erase(found);
    return answer(order.contains("error")
                      ? Result<Json>(Error{Code::NotFound, order.at("error").get<std::string>()})
                      : Result<Json>(order));
  }
  const auto found = modules_.find(order.value("number", std::int64_t{0}));
  if (found != modules_.end()) found->second->obey(what, order);
} catch (const Json::exception& error) {
  lose(std::string("malformed message: ") + error.what());
}

/// Handles the first message of the agent.
void Connection::greet(const Json& hello) {
  ssh_->greeted();
  const std::string version = hello.value("version", "");
  if (version != parts_.version)
    return lose("it has hc " + version + ", but this is hc " + parts_.version +
                ": install the same version");
  place_.address = parts_.declared.address.value;
  if (place_.address.empty()) place_.address = address_in(hello, "address");
  place_.runner = address_in(hello, "runner");
  place_.fingerprint = parts_.fingerprint;
  send({{"what", "key"}, {"key", parts_.key}});
  estimate_ = {};
  there_to_wall_.reset();
  first_exchanges_ = 0;
  greeted_ = Clock::now();
  send_heartbeat();
}

/// Handles an answer to a heartbeat. The connection counts as made after the first few, sent back
/// to back, so that its clock is known even if one of them was late.
void Connection::take_times(const Moments& times, MonotonicTime received) {
  if (!ssh_->is_greeted()) return;
  using std::chrono::nanoseconds;
  const nanoseconds asked(times[0]), taken(times[1]), answered(times[2]);
  const auto there = std::clamp(nanoseconds(times[3]), -kMostApart, kMostApart);
  check_clock(there);
  if (asked.count() == 0) return;
  estimate_.add({asked, taken, answered, received});
  if (!state_.is_connected && ++first_exchanges_ < kFirstExchanges &&
      Clock::now() < greeted_ + kLongestFirst)
    return ask_time();
  const auto here = monotonic_to_wall(), now = monotonic_now();
  wall_offset_ = here - estimate_.offset(now);
  state_.offset = seconds(estimate_.offset(now)) + seconds(there - here);
  state_.error = seconds(estimate_.error(now));
  state_.drift = estimate_.drift();
  state_.latency = seconds(estimate_.delay());
  if (!std::exchange(state_.is_connected, true)) finish_connecting();
}

/// Asks again for the ports and readers of an earlier connection.
void Connection::finish_connecting() {
  connected_ = Clock::now();
  state_.detail.clear();
  for (const auto& each : ports_)
    ask_for_port(each.second, each.first,
                 [this, number = each.first](const Result<std::uint16_t>& port) {
                   if (!port)
                     parts_.log(hc::format("host {}: lost port {}: {}", parts_.declared.name,
                                           number, port.error().detail));
                 });
  for (const auto& [number, uri] : readers_)
    send({{"what", "read"}, {"number", number}, {"uri", uri}});
  for (std::size_t i = 0; i < kSpares; ++i) ask_for_spare();
  if (const auto opened = std::exchange(opened_, {}))
    opened({});
  else
    parts_.log("host " + parts_.declared.name + ": reconnected");
  parts_.changed();
}

/// Logs that the wall clock of the host was set.
void Connection::check_clock(std::chrono::nanoseconds there_to_wall) {
  if (there_to_wall_ && std::chrono::abs(there_to_wall - *there_to_wall_) > kClockSet)
    parts_.log(hc::format(
        "host {}: its clock was set by {:.3f} s; the times in its messages are not affected",
        parts_.declared.name, seconds(there_to_wall - *there_to_wall_)));
  there_to_wall_ = there_to_wall;
}

void Connection::ask_for_spare() {
  ask_for_port(true, 0, [this](const Result<std::uint16_t>& port) {
    if (port) spares_.push_back(*port);
  });
}

void Connection::ask_time() {
  send({{"what", "heartbeat"}, {"times", Moments{monotonic_now().count(), 0, 0, 0}}});
}

void Connection::send_heartbeat() {
  if (!ssh_) return;
  ask_time();
  heartbeat_ = loop_.call_at(Clock::now() + kHeartbeat, [this] { send_heartbeat(); });
}

/// Ends all modules and questions after the connection was lost or could not be made. Reconnects,
/// unless it was the first attempt.
void Connection::lose(const std::string& why) {
  const std::string reason = ssh_ ? ssh_->reason_of(why) : why;
  const bool was_connected = std::exchange(state_.is_connected, false);
  state_.detail = reason;
  state_.offset = state_.error = state_.drift = state_.latency = {};
  spares_.clear();
  // Callbacks may add and remove modules, so iterate over a copy.
  for (const auto& [number, known] : std::map(modules_))
    if (const auto module = modules_.find(number); module != modules_.end())
      module->second->ended(kHostLost);
  for (const auto& [id, answered] : std::exchange(questions_, {})) answered(not_connected());
  heartbeat_.reset();
  const bool is_out_of_reach = ssh_ && ssh_->is_out_of_reach();
  // It may be the caller, so it is destroyed later.
  if (ssh_) ssh_->close();
  again_ = loop_.call_at(Clock::now(), [this] {
    disconnect();
    if (!is_closed_) again_ = loop_.call_at(Clock::now() + pause_.next(), [this] { connect(); });
  });
  if (const auto opened = std::exchange(opened_, {})) {
    is_closed_ = true;
    return opened(Error{is_out_of_reach ? Code::NotFound : Code::Closed, reason});
  }
  if (is_closed_) return;
  if (was_connected && Clock::now() - connected_ > kLasting) pause_.reset();
  if (was_connected)
    parts_.log("host " + parts_.declared.name + ": connection lost: " + reason + "; reconnecting");
  parts_.changed();
}

void Connection::disconnect() {
  heartbeat_.reset();
  ssh_.reset();
}

}  // namespace hc::hosts
