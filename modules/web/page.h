// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the server serves: the page, the graph, its streams, the driver's seat and recordings
// (spec/page.md). For the server's thread, but for what is said otherwise.

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <hc/base/clock.h>

#include <client/graph_client.h>
#include <web/access.h>
#include <web/server.h>
#include "driver.h"
#include "recorder.h"
#include "stop.h"
#include "stream.h"

namespace web = hc::web;

/// What the workspace says of the robot; Unknown: the graph has none, or it is silent.
enum class Stopped : std::uint8_t { Unknown, No, Yes };

/// What the module and its page share. From any thread.
struct Robot {
  std::atomic<unsigned> linked{0};  ///< a bit for each Control whose output is linked
  std::atomic<Stopped> stopped{Stopped::Unknown};
  std::atomic<unsigned> sessions{0};        ///< pages that are open
  std::atomic<hc::MonotonicTime> served{};  ///< when the server's thread ran
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
    std::function<void(Order)> order;  ///< something is commanded
    /// The robot is to be stopped, or the stop is cleared; answered on the module's thread.
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
    std::string sent;           // of what it is, the last
    std::int64_t commands = 0;  // that came
  };
  /// A command: its session, and its number among those of the session, from 0 on.
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
  // These give what is wrong, or nothing: it is done, and answered, later.
  /// Stops the robot, or clears that.
  std::optional<std::vector<std::string>> stop(const Asked& asked,
                                               const std::vector<std::string>& words);
  /// Begins a recording, or ends it.
  std::optional<std::vector<std::string>> record(const Asked& asked,
                                                 const std::vector<std::string>& words);
  /// Ends the recording, and then calls back.
  std::optional<std::vector<std::string>> end_recording(const std::function<void()>& ended);
  /// As Server::aside(), for what begins or ends a recording.
  std::optional<std::vector<std::string>> record_aside(web::Work work);
  void answer(const Asked& asked, const std::vector<std::string>& rows);
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
  std::uint64_t next_ = 1;  // number of a session
  Sessions sessions_;
  std::map<std::string, std::shared_ptr<Stream>> streams_;  // by port
  std::shared_ptr<web::WebSocket> driver_socket_;
  Driver driver_;
  std::shared_ptr<Recorder> recorder_;
  std::weak_ptr<web::Work> recording_job_;  // that begins or ends it
  web::Bytes state_;                        // the last
  std::set<std::int32_t> modes_;            // numbers of those that the graph has
  std::deque<web::Bytes> log_;              // the last lines
  std::int64_t states_ = 0, lines_ = 0;     // sent
  hc::GraphClient graph_;
};
