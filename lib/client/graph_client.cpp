// SPDX-License-Identifier: Apache-2.0
#include <client/graph_client.h>

#include <unistd.h>

#include <atomic>
#include <utility>

#include <hc/base/format.h>

namespace hc {
namespace {

using internal::Intake;
using std::chrono::steady_clock;

constexpr std::size_t kMaxWaiting = 256;        // commands
constexpr std::chrono::seconds kCheck{10};      // a graph publishes twice a second
constexpr std::chrono::minutes kAnswerTime{2};  // it may have to wait for a slow program

}  // namespace

GraphClient::GraphClient(Loop& loop, RunningGraph graph) : loop_(loop), graph_(std::move(graph)) {}

GraphClient::~GraphClient() {
  if (commands_) commands_->abandon();
}

Status GraphClient::watch(Callbacks callbacks) {
  callbacks_ = std::move(callbacks);
  LinkOptions options;
  options.limits.element_bytes = kMaxStateBytes;
  states_ = HC_TRY(Intake::make(
      loop_, graph_.state_uri(), [this](const Message& message) { take(message); }, options));
  states_->on_end([this] { end(); });
  return {};
}

void GraphClient::take(const Message& message) {
  is_alive_ = true;
  const auto text = message.text();
  if (message.header.src == static_cast<std::int32_t>(GraphReport::Log)) {
    if (const auto line = parse_log_line(text)) callbacks_->log(*line, text);
  } else if (message.header.src == static_cast<std::int32_t>(GraphReport::State)) {
    if (const auto state = parse_graph_state(text)) callbacks_->state(*state, text);
  }
}

void GraphClient::end() {
  fail({Code::Closed, graph_.text() + " has ended"});
  callbacks_->end();
}

Status GraphClient::open() {
  static std::atomic<unsigned> clients{0};
  // With the time, as containers that share a network have equal numbers of processes.
  reply_ = hc::format("unix:@hypercolumn-answer.{}.{}.{}", ::getpid(), clients++,
                      steady_clock::now().time_since_epoch().count());
  auto answers = HC_TRY(Intake::make(loop_, "unix-listen" + reply_.substr(reply_.find(':')),
                                     [this](const Message& message) { take_answer(message); }));
  auto uri = HC_TRY(parse_uri(graph_.command_uri()));
  uri.options = {{"keep", std::to_string(kMaxWaiting)}};  // so that sending never blocks
  auto commands = HC_TRY(open_sink(uri));
  answers_ = std::move(answers);
  commands_ = std::move(commands);
  return {};
}

void GraphClient::command(std::vector<std::string> lines, Answered answered) {
  if (waiting_.size() >= kMaxWaiting)
    return answered(
        Error{Code::TooLarge,
              hc::format("{} commands are waiting already; try again later", kMaxWaiting)});
  if (!commands_)
    if (auto opened = open(); !opened) return answered(opened.error());
  auto message = make_request({reply_, std::move(lines)});
  const auto number = message.header.seq = sent_++;
  if (auto sent = commands_->send(message); !sent) {
    commands_.reset();
    return answered(sent.error());
  }
  waiting_[number] = {std::move(answered), steady_clock::now() + kAnswerTime};
  if (!check_) check_ = loop_.call_at(steady_clock::now() + kCheck, [this] { check(); });
}

void GraphClient::take_answer(const Message& message) {
  is_alive_ = true;
  auto found = waiting_.extract(message.header.seq);
  if (found) found.mapped().answered(read_answer(message));
}

/// Fails all commands if the graph has been silent since the last check, or is late with an answer.
void GraphClient::check() {
  if (waiting_.empty()) return check_.reset();
  const bool is_late = steady_clock::now() >= waiting_.begin()->second.until;
  if (!std::exchange(is_alive_, false) && states_)
    return fail({Code::Closed, graph_.text() + " does not answer"});
  if (is_late) return fail({Code::Closed, graph_.text() + " has not answered for 2 minutes"});
  if (!states_)
    if (auto watched = watch({[](const auto&, auto) {}}); !watched)
      return fail({Code::Closed, graph_.text() + " has ended"});
  check_ = loop_.call_at(steady_clock::now() + kCheck, [this] { check(); });
}

void GraphClient::fail(const Error& error) {
  check_.reset();
  for (auto& [number, waiting] : std::exchange(waiting_, {})) waiting.answered(error);
}

Result<GraphAnswer> ask(const RunningGraph& graph, std::vector<std::string> commands, int stop) {
  auto loop = HC_TRY(Loop::make());
  std::optional<Result<GraphAnswer>> answer;
  const auto stopped = HC_TRY(loop->watch(stop, stop < 0 ? 0U : EPOLLIN, [&](auto) {
    answer = Error{Code::Stopped, "asked to stop"};
  }));
  GraphClient client(*loop, graph);
  client.command(std::move(commands), [&](const auto& answered) { answer = answered; });
  while (!answer) HC_TRY(loop->turn());
  return *answer;
}

}  // namespace hc
