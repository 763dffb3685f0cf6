// SPDX-License-Identifier: Apache-2.0
#include <graph/run/graph_server.h>

#include <array>
#include <utility>

#include <hc/base/clock.h>
#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

constexpr std::chrono::milliseconds kSoon{20};

Message stamped(const std::string& row, GraphReport what, std::int64_t& seq) {
  Message message = make_rows(std::array{row});
  message.header.src = static_cast<std::int32_t>(what);
  message.header.seq = seq++;
  message.header.time = SystemClock().wall();
  return message;
}

/// The listening URI for a client's URI.
std::string listening(const std::string& uri) {
  return "unix-listen" + uri.substr(uri.find(':'));
}

}  // namespace

Result<std::unique_ptr<GraphServer>> GraphServer::make(Loop& loop, const RunningGraph& graph,
                                                       Callbacks callbacks) {
  std::unique_ptr<GraphServer> server(new GraphServer(loop, std::move(callbacks)));
  auto& self = *server;
  auto states = Announcer::make(loop, listening(graph.state_uri()),
                                [&self] { return std::vector{self.state_message()}; });
  if (!states)
    return Error{states.error().code, states.error().detail +
                                          "; another container on this network may run a "
                                          "graph of this name: give this one another with --as"};
  self.states_ = std::move(*states);
  LinkOptions options;
  options.limits.element_bytes = kMaxCommandBytes;
  self.commands_ = HC_TRY(Intake::make(
      loop, listening(graph.command_uri()),
      [&self](const Message& message) { self.take_request(message); }, options));
  return server;
}

Message GraphServer::state_message() {
  return stamped(to_json(callbacks_.state()), GraphReport::State, states_sent_);
}

void GraphServer::publish_state() {
  if (!has_clients()) return;
  soon_.reset();
  states_->send(state_message());
}

void GraphServer::changed() {
  if (!has_clients() || soon_) return;
  soon_ = loop_.call_at(std::chrono::steady_clock::now() + kSoon, [this] { publish_state(); });
}

void GraphServer::log(const LogLine& line) {
  if (has_clients()) states_->send(stamped(to_json(line), GraphReport::Log, lines_sent_));
}

void GraphServer::take_request(const Message& message) const {
  const auto request = read_request(message);
  callbacks_.obey(request.lines,
                  [to = request.reply, seq = message.header.seq](const auto& answer) {
                    if (to.empty()) return;
                    auto reply = make_answer(answer);
                    reply.header.seq = seq;
                    static_cast<void>(send_at_once(to, reply));  // the client may have left
                  });
}

}  // namespace hc::internal
