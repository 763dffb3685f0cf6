// SPDX-License-Identifier: Apache-2.0
#include <hosts/connection.h>

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include <graph/held_port.h>
#include <hc/base/clock.h>
#include <hc/base/format.h>
#include <hosts/answer.h>

namespace hc::hosts {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kGreeting{20000};  // until ssh has connected and the agent has spoken
constexpr milliseconds kAnswerTime{30000};
constexpr std::chrono::seconds kLasting{10};  // a connection that counts as one
constexpr int kFirstExchanges = 8;            // of the clock, unless they take longer:
constexpr milliseconds kLongestFirst{300};
constexpr std::size_t kSpares = 4;
constexpr std::size_t kMaxErrorText = 4096;  // [byte]
constexpr std::size_t kUsageColumns = 5;

/// A word of a command line that a shell is to take as it is, but for ~/ at its begin.
std::string quoted(const std::string& word) {
  std::string text = word.starts_with("~/") ? "~/'" : "'";
  for (char c : word.substr(text.size() - 1)) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::vector<std::string> ssh_command(const GraphHost& host) {
  // No terminal, no question, nothing forwarded or shared; and it notices a cut network.
  std::vector<std::string> words = {"ssh", "-T", "-x", "-a"};
  for (const char* option :
       {"BatchMode=yes", "ConnectTimeout=10", "ServerAliveInterval=1", "ServerAliveCountMax=3",
        "ClearAllForwardings=yes", "ControlMaster=no", "RemoteCommand=none", "EscapeChar=none"})
    words.insert(words.end(), {"-o", option});
  for (const auto& word : host.ssh) words.push_back(word.value);
  words.push_back("exec " + quoted(host.program.value) + " agent");
  return words;
}

/// The port in an answer; 0: there is none.
std::uint16_t port_in(const Json& answer) {
  const auto port = answer.find("port");
  if (port == answer.end() || !port->is_number_unsigned()) return 0;
  const auto number = port->get<std::uint64_t>();
  return number <= UINT16_MAX ? static_cast<std::uint16_t>(number) : std::uint16_t{0};
}

/// An address that an agent tells; empty where links cannot use it, such as a link-local one.
std::string address_in(const Json& hello, const char* key) {
  const std::string text = hello.value(key, "127.0.0.1");  // ssh that connects to nothing
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const bool is_address = ::inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
                          ::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
  return is_address ? text : "";
}

Error not_connected() {
  return {Code::Closed, "it is not connected"};
}

/// The last line of a text that is not empty, as a terminal may have it.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
    text.pop_back();
  std::string line = text.substr(text.rfind('\n') + 1);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return line;
}

constexpr std::string_view kHowToInstall =
    R"(; install Hypercolumn there, or say where its hc is: hc = "PATH")";

}  // namespace

bool Connection::is_of(const GraphHost& declared) const {
  auto words = [](const GraphHost& host) {
    std::vector<std::string> list = {host.program.value, host.address.value};
    for (const auto& word : host.ssh) list.push_back(word.value);
    return list;
  };
  return words(declared) == words(parts_.declared);
}

void Connection::open(std::function<void(Status)> opened) {
  opened_ = std::move(opened);
  connect();
}

void Connection::close() {
  is_closed_ = true;
  if (conversation_) lose("closed");
  again_.reset();
  disconnect();
}

void Connection::ask(Json question, Answered answered) {
  if (!state_.is_connected) return answered(not_connected());
  question["id"] = ++asked_;
  questions_[asked_] = std::move(answered);
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
          // So that the rest of the graph can be changed while this host is away.
          if (!answered && answered.error().code == Code::Closed && !known.is_null())
            answered = known;
          give(std::move(answered));
        });
      }));
  const auto text = answer.find("text");
  if (text == answer.end() || !text->is_string()) return Error{Code::Malformed, "no text"};
  return text->get<std::string>();
}

Result<std::string> Connection::find_program(const std::string& name, int stop) {
  return ask_text("find", name, stop);
}

Result<std::string> Connection::describe_program(const std::string& program, int stop) {
  return ask_text("describe", program, stop);
}

Result<std::string> Connection::examine(const std::string& question, int stop) {
  return ask_text("examine", question, stop);
}

Result<std::shared_ptr<const HeldPort>> Connection::hold_port(bool of_all_addresses, int stop) {
  return answer_of<std::shared_ptr<const HeldPort>>(
      loop_, stop, kAnswerTime, [self = shared_from_this(), of_all_addresses](const auto& give) {
        self->ask({{"what", "hold"}, {"of_all", of_all_addresses}, {"port", 0}},
                  [self, of_all_addresses, give](const Result<Json>& answer) {
                    const auto port = answer ? port_in(*answer) : std::uint16_t{0};
                    if (!answer) return give(answer.error());
                    if (port == 0) return give(Error{Code::Malformed, "no port"});
                    give(self->held(port, of_all_addresses));
                  });
      });
}

// On the loop's thread.

/// A port there, released when its last owner ends, on whichever thread.
std::shared_ptr<const HeldPort> Connection::held(std::uint16_t number, bool of_all) {
  ports_[number] = of_all;
  return {new HeldPort{internal::Descriptor(), number},
          [host = weak_from_this()](const HeldPort* port) {
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
  want_spare();
  return held(number, true);
}

std::unique_ptr<ModuleProcess> Connection::make_process(const PlannedModule& module,
                                                        ModuleCallbacks callbacks) {
  return std::make_unique<RemoteModule>(shared_from_this(), ++numbered_, module.manage_uri,
                                        std::move(callbacks));
}

std::shared_ptr<void> Connection::read_in_place(const std::string& reader_uri) {
  const auto number = ++numbered_;
  readers_[number] = reader_uri;
  send({{"what", "read"}, {"number", number}, {"uri", reader_uri}});
  // Only that it goes is of interest.
  return {this, [host = weak_from_this(), number](void*) {
            auto self = host.lock();
            if (!self) return;
            self->readers_.erase(number);
            self->send({{"what", "leave"}, {"number", number}});
          }};
}

void Connection::connect() {
  disconnect();
  is_greeted_ = false;
  error_text_.clear();
  auto ssh = Process::start(ssh_command(parts_.declared), Process::Capture::Both);
  if (!ssh) return lose(ssh.error().detail);
  ssh_.emplace(std::move(*ssh));
  auto errors = loop_.watch(ssh_->errors(), EPOLLIN, [this](auto) { read_ssh_errors(); });
  if (!errors) return lose(errors.error().detail);
  ssh_errors_ = std::move(*errors);
  auto conversation = Conversation::make(loop_, ssh_->output(), ssh_->input(), kGreeting,
                                         {[this](const Message& message) { take(message); },
                                          [this](const std::string& why) { lose(why); }});
  if (!conversation) return lose(conversation.error().detail);
  conversation_ = std::move(*conversation);
}

/// Keeps the last that ssh says: why it cannot connect.
void Connection::read_ssh_errors() {
  std::array<char, kMaxErrorText> piece;
  const ssize_t size = ::read(ssh_->errors(), piece.data(), piece.size());
  if (size == 0) ssh_errors_.reset();
  if (size <= 0) return;
  error_text_.append(piece.data(), static_cast<std::size_t>(size));
  if (error_text_.size() > kMaxErrorText) error_text_.erase(0, error_text_.size() - kMaxErrorText);
}

void Connection::take(const Message& message) {
  const auto received = monotonic_now();
  const auto& header = message.header;
  if (header.src == Order) return obey(read_order(message));
  if (header.src == Heartbeat) return take_heartbeat(message, received);
  if (header.src == Usage) return take_usage(message);
  const auto found = modules_.find(header.dst);
  if (found == modules_.end()) return;
  if (header.src == Log) return found->second->said(message.characters());
  if (header.src < Report) return;
  Message report = message;
  report.header.src -= Report;
  report.header.dst = 0;
  found->second->reported(report);
}

void Connection::obey(const Json& order) try {
  if (order.is_null()) return;
  const std::string what = order.at("what");
  if (what == "hello") return greet(order);
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
  if (found == modules_.end()) return;
  auto& module = *found->second;
  if (what == "started") module.started(order.at("process"));
  if (what == "listens") module.listens();
  if (what == "ended") {
    if (order.contains("error")) module.said(order.at("error").get<std::string>() + "\n");
    module.ended(std::clamp(order.at("status").get<int>(), 0, kHostLost - 1));
  }
} catch (const Json::exception& error) {
  lose(std::string("what it says is wrong: ") + error.what());
}

/// The agent is there, and says who it is.
void Connection::greet(const Json& hello) {
  is_greeted_ = true;
  error_text_.clear();  // what ssh says to everybody
  const std::string version = hello.value("version", "");
  if (version != parts_.version)
    return lose("it has hc " + version + ", and this is hc " + parts_.version +
                ": install the same");
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

/// The first answers to a beat, one right behind the other, make the connection: then its clock is
/// known, also where one of them was late.
void Connection::take_heartbeat(const Message& message, std::int64_t received) {
  const auto moments = read_numbers(message, Moments().size());
  if (moments.size() != Moments().size() || !is_greeted_) return;
  const auto there = moments[3];
  look_at_clock(there);
  if (moments[0] == 0) return;
  estimate_.add({moments[0], moments[1], moments[2], received});
  if (!state_.is_connected && ++first_exchanges_ < kFirstExchanges &&
      Clock::now() < greeted_ + kLongestFirst)
    return ask_time();
  const auto here = monotonic_to_wall(), now = monotonic_now();
  wall_offset_ = here - estimate_.offset(now);
  state_.offset = seconds(estimate_.offset(now) + there - here);
  state_.error = seconds(estimate_.error(now));
  state_.drift = estimate_.drift();
  state_.latency = seconds(estimate_.delay());
  if (!std::exchange(state_.is_connected, true)) begin_work();
}

/// The host is connected: asks again for the ports and readers that outlast a connection.
void Connection::begin_work() {
  connected_ = Clock::now();
  state_.detail.clear();
  for (const auto& each : ports_)
    ask({{"what", "hold"}, {"of_all", each.second}, {"port", each.first}},
        [this, number = each.first](const Result<Json>& answer) {
          if (!answer)
            parts_.log(hc::format("host {}: port {} is lost: {}", parts_.declared.name, number,
                                  answer.error().detail));
        });
  for (const auto& [number, uri] : readers_)
    send({{"what", "read"}, {"number", number}, {"uri", uri}});
  for (std::size_t i = 0; i < kSpares; ++i) want_spare();
  if (const auto opened = std::exchange(opened_, {}))
    opened({});
  else
    parts_.log("host " + parts_.declared.name + ": connected again");
  parts_.changed();
}

/// Notices that the clock there was set.
void Connection::look_at_clock(std::int64_t there_to_wall) {
  if (there_to_wall_ && std::abs(there_to_wall - *there_to_wall_) > kClockSet)
    parts_.log(hc::format(
        "host {}: its clock was set by {:.3f} s; times of its messages stay right",
        parts_.declared.name, static_cast<double>(there_to_wall - *there_to_wall_) * 1e-9));
  there_to_wall_ = there_to_wall;
}

void Connection::want_spare() {
  ask({{"what", "hold"}, {"of_all", true}, {"port", 0}}, [this](const Result<Json>& answer) {
    if (const auto port = answer ? port_in(*answer) : std::uint16_t{0}; port != 0)
      spares_.push_back(port);
  });
}

void Connection::take_usage(const Message& message) {
  const auto numbers = read_numbers(message, kUsageColumns);
  for (std::size_t i = 0; i + kUsageColumns <= numbers.size(); i += kUsageColumns) {
    const auto found = modules_.find(numbers[i]);
    if (found == modules_.end()) continue;
    found->second->started(static_cast<pid_t>(numbers[i + 1]));
    found->second->used({std::chrono::nanoseconds(numbers[i + 2]),
                         static_cast<std::uint64_t>(numbers[i + 3]), numbers[i + 4] != 0});
  }
}

void Connection::ask_time() {
  const Moments moments{monotonic_now(), 0, 0, 0};
  conversation_->say(make_numbers(Heartbeat, moments, moments.size()));
}

void Connection::send_heartbeat() {
  if (!conversation_) return;
  ask_time();
  heartbeat_ = loop_.call_at(Clock::now() + kHeartbeat, [this] { send_heartbeat(); });
}

/// Why the connection is lost: what ssh says, and else what was noticed here.
std::string Connection::reason_of(const std::string& noticed) const {
  std::string said = last_line(error_text_);
  auto is_said = [&](std::string_view words) { return said.find(words) != std::string::npos; };
  if (!is_greeted_ && (is_said("not found") || is_said("No such file")))
    return said + std::string(kHowToInstall);
  if (!said.empty()) return said;
  const bool is_noise = !is_greeted_ && noticed.starts_with(Conversation::kNoMessage);
  return noticed +
         (is_noise ? "; what a shell there starts with, as ~/.bashrc, must print nothing" : "");
}

/// The connection is lost, or has never been there: what ran over it is over. It is tried again
/// unless it has never been.
void Connection::lose(const std::string& why) {
  if (ssh_) read_ssh_errors();
  const std::string reason = reason_of(why);
  const bool was_connected = std::exchange(state_.is_connected, false);
  state_.detail = reason;
  state_.offset = state_.error = state_.drift = state_.latency = {};
  spares_.clear();
  // They may come and go meanwhile.
  for (const auto& [number, known] : std::map(modules_))
    if (const auto module = modules_.find(number); module != modules_.end())
      module->second->ended(kHostLost);
  for (const auto& [id, answered] : std::exchange(questions_, {})) answered(not_connected());
  heartbeat_.reset();
  // What calls this may be the conversation, which must not be destroyed then.
  if (conversation_) conversation_->close();
  again_ = loop_.call_at(Clock::now(), [this] { disconnect(); });
  if (const auto opened = std::exchange(opened_, {})) {
    is_closed_ = true;
    return opened(Error{Code::Closed, reason});
  }
  if (is_closed_) return;
  if (was_connected && Clock::now() - connected_ > kLasting) pause_.reset();
  if (was_connected)
    parts_.log("host " + parts_.declared.name + ": lost: " + reason + "; connecting again");
  parts_.changed();
  again_ = loop_.call_at(Clock::now(), [this] {
    disconnect();
    again_ = loop_.call_at(Clock::now() + pause_.next(), [this] { connect(); });
  });
}

void Connection::disconnect() {
  conversation_.reset();
  ssh_errors_.reset();
  heartbeat_.reset();
  ssh_.reset();
}

}  // namespace hc::hosts
