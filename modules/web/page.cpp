// SPDX-License-Identifier: Apache-2.0
#include "page.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include <hc/base/words.h>
#include <hc/contract/description.h>
#include <hc/mtp/codec.h>
#include <hc/mtp/rows.h>
#include <hc/mtp/stream_reader.h>

#include "assets.h"

namespace {

using Rows = std::vector<std::string>;

// The src of messages to a page; the first two are the graph's (GraphReport).
constexpr std::int32_t kState = 1, kLog = 2, kSession = 3, kAnswer = 4;
constexpr std::size_t kMaxLog = 200;                          // lines sent when a page opens
constexpr std::size_t kMaxStates = 8, kMaxWaiting = 512;      // messages queued for a slow page
constexpr int kGoing = 1001, kInvalid = 1007, kTaken = 4409;  // close codes, as kEnd

constexpr const char* kPolicyText =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "media-src blob:; connect-src 'self'; worker-src 'self' blob:; font-src 'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

web::Bytes text(std::string words) {
  return std::make_shared<const std::string>(std::move(words));
}

using web::refusal;

web::Reply made_of(int status, decltype(web::Reply::fields) fields, std::string type = {},
                   web::Bytes body = nullptr) {
  web::Reply reply;
  reply.status = status;
  reply.type = std::move(type);
  reply.body = std::move(body);
  reply.fields = std::move(fields);
  return reply;
}

/// The error for a session that lacks a right.
std::string lacks(web::Right has, web::Right needed) {
  return "this session may " + std::string(name_of(has)) + "; that needs the right to " +
         std::string(name_of(needed));
}

/// The one message in a frame. Errors: Malformed.
hc::Result<hc::Message> read_frame(std::string_view bytes) {
  hc::StreamReader reader;
  hc::Message message;
  std::optional<hc::Message> found;
  while (true) {
    auto got = reader.next(message);
    if (!got) return got.error();
    if (*got && found) return hc::Error{hc::Code::Malformed, "more than one message in a frame"};
    if (*got) {
      found = message.keep();
      continue;
    }
    if (bytes.empty()) break;
    const auto space = reader.space();
    const auto size = std::min(space.size(), bytes.size());
    std::memcpy(space.data(), bytes.data(), size);
    reader.commit(size);
    bytes.remove_prefix(size);
  }
  if (auto whole = reader.finish(); !whole) return whole.error();
  if (!found) return hc::Error{hc::Code::Malformed, "no message in a frame"};
  return *found;
}

}  // namespace

Page::Page(Options options, web::Access& access, web::Server& server, Robot& robot,
           Callbacks callbacks)
    : options_(std::move(options)),
      access_(access),
      server_(server),
      robot_(robot),
      callbacks_(std::move(callbacks)),
      recordings_(options_.graph, {options_.recordings, options_.frames, callbacks_.log}, server),
      graph_(server.loop(), options_.graph) {
  server_.every(std::chrono::milliseconds(25), [this] { tick(); });
  const auto watched = graph_.watch(
      {[this](const auto& state, std::string_view json) { take_state(state, json); },
       [this](const auto&, std::string_view json) { take_log(json); }, [this] { close(); }});
  if (!watched)
    callbacks_.log(hc::Level::Info, "cannot observe the graph: " + watched.error().detail);
}

Page::~Page() = default;

// HTTP.

web::Reply Page::reply(const web::Request& request) {
  if (!access_.is_host(request.host))
    return refusal(421, "this server is not \"" + request.host.substr(0, 64) +
                            "\"; open it by the URL that it printed");
  if (request.path == "/" && !web::option(request.query, "token").empty())
    return reply_to_token(request);
  const auto right = access_.right_of(request.cookies);
  if (!right)
    return refusal(401,
                   "This page needs the URL that was printed when the graph started; each works "
                   "once, and the log has a new one.");
  if (request.is_socket) {
    if (!access_.is_origin(request.origin, request.host))
      return refusal(403, "a page from another origin may not use this server");
    if (request.path == "/drive" && *right < web::Right::Drive)
      return refusal(403, lacks(*right, web::Right::Drive));
    const bool is_known =
        request.path == "/graph" || request.path == "/drive" ||
        (request.path.starts_with("/streams/") && hc::is_port_name(request.path.substr(9)));
    return is_known ? made_of(101, {}) : refusal(404, "no such socket");
  }
  if (request.path == "/recordings" || request.path.starts_with("/recordings/"))
    return recordings_.reply(request.path);
  return reply_with_file(request);
}

web::Reply Page::reply_to_token(const web::Request& request) {
  // A URL that opens a browser is visible to other users in the browser's command line.
  if (request.is_another_user)
    return refusal(403, "on this machine only the user running the graph may open the page");
  const auto session = access_.redeem(web::option(request.query, "token"));
  if (!session) {
    // With a session, the same link was opened again.
    if (!access_.right_of(request.cookies))
      return refusal(401, "the token is wrong or already used; the log has a new one");
    return made_of(303, {{"Location", "/"}});
  }
  callbacks_.log(hc::Level::Notice,
                 "page opened; for another browser: " + access_.invite(web::Right::Operate));
  return made_of(303, {{"Location", "/"},
                       {"Set-Cookie",
                        access_.cookie_name() + "=" + *session + "; HttpOnly; SameSite=Strict; " +
                            (access_.place().is_secure ? "Secure; " : "") + "Path=/"}});
}

web::Reply Page::reply_with_file(const web::Request& request) const {
  const std::string_view path =
      request.path == "/" ? std::string_view("/index.html") : std::string_view(request.path);
  const auto found = std::ranges::find_if(
      page_assets(), [&](const Asset& asset) { return asset.path == path.substr(1); });
  if (found == page_assets().end()) return refusal(404, "no such file");
  // Assets live as long as the program.
  return made_of(200,
                 {{"Content-Encoding", "gzip"},
                  {"Cache-Control", "no-cache"},
                  {"Content-Security-Policy", kPolicyText}},
                 std::string(found->type), text(std::string(found->bytes)));
}

// Sockets.

void Page::open(std::shared_ptr<web::WebSocket> socket, const web::Request& request) {
  const auto right = access_.right_of(request.cookies);
  if (!right) return socket->close(kPolicy, "the session has ended");
  if (request.path == "/graph") return open_graph(socket, *right);
  if (request.path == "/drive") return open_drive(socket, request);
  open_stream(socket, request);
}

void Page::open_graph(const std::shared_ptr<web::WebSocket>& socket, web::Right right) {
  const auto number = next_++;
  Session& session = sessions_[number] = {socket, right, {}};
  robot_.sessions = static_cast<unsigned>(sessions_.size());
  socket->on_close = [this, number] {
    sessions_.erase(number);
    robot_.sessions = static_cast<unsigned>(sessions_.size());
  };
  socket->on_text = [this, number](std::string_view command) {
    take_command(number, std::string(command));
  };
  send_session(session);
  if (state_) socket->send(state_);
  for (const auto& line : log_) socket->send(line);
}

void Page::open_stream(const std::shared_ptr<web::WebSocket>& socket, const web::Request& request) {
  const auto wanted = parse_wanted(request.query);
  if (!wanted) return socket->close(kPolicy, wanted.error().detail);
  const std::string port = request.path.substr(std::string_view("/streams/").size());
  auto found = streams_.find(port);
  if (found == streams_.end()) {
    auto post = [this](std::function<void()> call) { server_.post(std::move(call)); };
    found = streams_.emplace(port, std::make_shared<Stream>(options_.graph, port, std::move(post)))
                .first;
  }
  found->second->view(*wanted, socket);
}

void Page::open_drive(const std::shared_ptr<web::WebSocket>& socket, const web::Request& request) {
  if (driver_socket_ && web::option(request.query, "take") != "1")
    return socket->close(kTaken, "another page drives");
  if (driver_socket_) {
    give(driver_.leave(clock_.wall()));
    driver_socket_->close(kTaken, "another page has taken the seat");
  }
  driver_socket_ = socket;
  driver_ = Driver();
  auto leave = [this, raw = socket.get()] {
    if (driver_socket_.get() != raw) return;
    give(driver_.leave(clock_.wall()));
    driver_socket_.reset();
  };
  socket->on_close = leave;
  socket->on_binary = [this, leave, raw = socket.get()](std::string_view bytes) {
    auto message = read_frame(bytes);
    if (message) {
      auto orders = driver_.take(std::move(*message), modes_, clock_.wall(), clock_.monotonic());
      if (orders) return give(*orders);
      if (orders.error().code == hc::Code::Invalid)
        return driver_socket_->send_text(orders.error().detail);
      message = orders.error();
    }
    const auto kept = driver_socket_;
    leave();
    if (kept.get() == raw) kept->close(kInvalid, message.error().detail);
  };
}

// The graph.

web::Bytes Page::rows_message(const Rows& rows, std::int32_t src, std::int64_t seq) const {
  hc::Message message = hc::make_rows(rows);
  message.header.src = src;
  message.header.seq = seq;
  message.header.time = clock_.wall();
  return text(hc::encode(message));
}

// A page that does not read gets no more messages; only the newest states and few lines matter.

void Page::take_state(const hc::GraphState& state, std::string_view json) {
  modes_.clear();
  for (const auto& [name, number] : state.modes) modes_.insert(static_cast<std::int32_t>(number));
  state_ = rows_message({std::string(json)}, kState, states_++);
  for (auto& [number, session] : sessions_)
    if (session.socket->waiting() < kMaxStates) session.socket->send(state_);
}

void Page::take_log(std::string_view json) {
  log_.push_back(rows_message({std::string(json)}, kLog, lines_++));
  if (log_.size() > kMaxLog) log_.pop_front();
  for (auto& [number, session] : sessions_)
    if (session.socket->waiting() < kMaxWaiting) session.socket->send(log_.back());
}

void Page::answer(const Asked& asked, const Rows& rows) {
  const auto found = sessions_.find(asked.session);
  if (found == sessions_.end() || found->second.socket->waiting() >= kMaxWaiting) return;
  found->second.socket->send(rows_message(rows, kAnswer, asked.number));
}

void Page::settle(const Asked& asked, const std::string& problem) {
  answer(asked, {problem.empty() ? "ok" : problem});
}

void Page::take_command(std::uint64_t number, const std::string& command) {
  Session& session = sessions_.at(number);
  const Asked asked{number, session.commands++};
  const auto parts = hc::words_of(command);
  const Rows words(parts.begin(), parts.end());
  if (words.empty()) return answer(asked, {"there is no command"});
  if (words[0] == "estop") return stop(asked, words);
  if (words[0] == "observe" || words[0] == "feed" || words[0] == "reply")
    return answer(asked, {"no command \"" + words[0] + "\"; streams are at /streams"});
  if (session.right < web::Right::Operate && words[0] != "describe")
    return answer(asked, {lacks(session.right, web::Right::Operate)});
  if (words[0] == "invite") return answer(asked, invite(words));
  if (words[0] == "record")
    return recordings_.take(words, [this, asked](const auto& problem) { settle(asked, problem); });
  graph_.command({command}, [this, asked](const hc::Result<hc::GraphAnswer>& answered) {
    Rows rows = answered ? answered->rows : Rows{answered.error().detail};
    if (answered && answered->is_ok) rows.insert(rows.begin(), "ok");
    answer(asked, rows);
  });
}

void Page::stop(const Asked& asked, const Rows& words) {
  const bool clears = words.size() == 2 && words[1] == "clear";
  if (words.size() > 1 && !clears) return settle(asked, "estop is followed by nothing or by clear");
  const auto right = sessions_.at(asked.session).right;
  if (clears && right < web::Right::Drive) return settle(asked, lacks(right, web::Right::Drive));
  callbacks_.stop(!clears, [this, asked](const std::string& problem) {
    server_.post([this, asked, problem] { settle(asked, problem); });
  });
}

Rows Page::invite(const Rows& words) {
  const auto right = words.size() == 2 ? web::right_named(words[1]) : std::nullopt;
  if (!right) return {"invite is followed by view, drive or operate"};
  return {"ok", access_.invite(*right)};
}

void Page::give(const std::vector<Order>& orders) const {
  for (const auto& order : orders) callbacks_.order(order);
}

void Page::tick() {
  robot_.served = clock_.monotonic();
  if (driver_socket_) give(driver_.tick(clock_.wall(), clock_.monotonic()));
  recordings_.tick();
  for (auto& [number, session] : sessions_) send_session(session);
  std::erase_if(streams_, [&](const auto& each) {
    const auto stop = [stream = each.second] {
      stream->stop();
      return [] {};
    };
    return !each.second->is_viewed() && server_.aside(stop).has_value();  // else later
  });
}

std::string Page::session_text(const Session& session) const {
  constexpr const char* kNames[] = {"",     "stick", "rotation", "target",
                                    "text", "bid",   "name",     "hold"};
  nlohmann::json now = {{"right", name_of(session.right)},
                        {"driver", nullptr},
                        {"stopped", nullptr},
                        {"recording", recordings_.current()},
                        {"drives", nlohmann::json::array()},
                        {"frames", options_.frames},
                        {"web", options_.module}};
  for (std::size_t i = 1; i < std::size(kNames); ++i)
    if ((robot_.linked & (1U << i)) != 0) now["drives"].push_back(kNames[i]);
  if (driver_socket_) now["driver"] = "other";
  if (const Stopped stopped = robot_.stopped; stopped != Stopped::Unknown)
    now["stopped"] = stopped == Stopped::Yes;
  return now.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void Page::send_session(Session& session) const {
  auto now = session_text(session);
  if (now == session.sent || session.socket->waiting() >= kMaxStates) return;
  session.sent = std::move(now);
  session.socket->send(rows_message({session.sent}, kSession, 0));
}

void Page::close() {
  for (auto& [number, session] : sessions_) session.socket->close(kGoing, "the graph has ended");
  for (auto& [port, stream] : streams_) stream->close("the graph has ended");
  if (driver_socket_) driver_socket_->close(kEnd, "the graph has ended");
  sessions_.clear();
  driver_socket_.reset();
}
