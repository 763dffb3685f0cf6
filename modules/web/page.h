// SPDX-License-Identifier: Apache-2.0
#pragma once
// Serves the page, the graph, its streams, the driver's seat and recordings (spec/page.md). For the
// server's thread, except as noted.

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <hc/base/clock.h>

#include <client/graph_client.h>
#include <web/access.h>
#include <web/server.h>
#include "driver.h"
#include "recordings.h"
#include "stop.h"
#include "stream.h"

namespace web = hc::web;

/// The stop reported by the workspace; Unknown if there is no workspace or it is silent.
enum class Stopped : std::uint8_t { Unknown, No, Yes };

/// State shared by the module and its page. From any thread.
struct Robot {
  std::atomic<unsigned> linked{0};  ///< a bit for each Control whose output is linked
  std::atomic<Stopped> stopped{Stopped::Unknown};
  std::atomic<unsigned> sessions{0};        ///< open pages
  std::atomic<hc::MonotonicTime> served{};  ///< when the server's thread last ran
};

class Page final : public web::Site {
 public:
  struct Options {
    hc::RunningGraph graph;
    std::string module;      ///< name of the module that serves the page
    std::string frames;      ///< of the graph, as text
    std::string recordings;  ///< folder
  };
  /// Called on the server's thread.
  struct Callbacks {
    std::function<void(Order)> order;
    /// Stops the robot, or clears the stop; answered on the module's thread.
    std::function<void(bool stops, Stop::Answer answer)> stop;
    hc::LogSink log;  ///< from any thread
  };

  Page(Options options, web::Access& access, web::Server& server, Robot& robot,
       Callbacks callbacks);
  ~Page() override;

  web::Reply reply(const web::Request& request) override;
  void open(std::shared_ptr<web::WebSocket> socket, const web::Request& request) override;

  void close() override;

 private:
  struct Session {
    std::shared_ptr<web::WebSocket> socket;
    web::Right right = web::Right::View;
    std::string sent;           // last session state sent
    std::int64_t commands = 0;  // received
  };
  /// A command: its session, and its number in the session, from 0.
  struct Asked {
    std::uint64_t session = 0;
    std::int64_t number = 0;
  };
  using Sessions = std::map<std::uint64_t, Session>;

  web::Reply reply_to_token(const web::Request& request);
  web::Reply reply_with_file(const web::Request& request) const;
  void open_graph(const std::shared_ptr<web::WebSocket>& socket, web::Right right);
  void open_stream(const std::shared_ptr<web::WebSocket>& socket, const web::Request& request);
  void open_drive(const std::shared_ptr<web::WebSocket>& socket, const web::Request& request);

  void take_state(const hc::GraphState& state, std::string_view json);
  void take_log(std::string_view json);
  [[nodiscard]] web::Bytes rows_message(const std::vector<std::string>& rows, std::int32_t src,
                                        std::int64_t seq) const;
  void take_command(std::uint64_t session, const std::string& command);
  std::vector<std::string> invite(const std::vector<std::string>& words);
  /// Stops the robot, or clears the stop.
  void stop(const Asked& asked, const std::vector<std::string>& words);
  void answer(const Asked& asked, const std::vector<std::string>& rows);
  /// Answers "ok", or the problem.
  void settle(const Asked& asked, const std::string& problem);
  void tick();
  void give(const std::vector<Order>& orders) const;
  [[nodiscard]] std::string session_text(const Session& session) const;
  void send_session(Session& session) const;

  const Options options_;
  web::Access& access_;
  web::Server& server_;
  Robot& robot_;
  const Callbacks callbacks_;
  const hc::SystemClock clock_;
  std::uint64_t next_ = 1;  // session number
  Sessions sessions_;
  std::map<std::string, std::shared_ptr<Stream>> streams_;  // by port
  std::shared_ptr<web::WebSocket> driver_socket_;
  Driver driver_;
  Recordings recordings_;
  web::Bytes state_;                     // latest
  std::set<std::int32_t> modes_;         // of the graph
  std::deque<web::Bytes> log_;           // last lines
  std::int64_t states_ = 0, lines_ = 0;  // sent
  hc::GraphClient graph_;
};
