// SPDX-License-Identifier: Apache-2.0
#pragma once
// An output of the graph as pages see it (spec/page.md, section 4): observed once, encoded once for
// all pages that want it alike, and each page gets the newest message when it is done with those
// before.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <client/tap.h>
#include <web/server.h>

#include "encoder.h"

namespace web = hc::web;

/// Why a socket is closed: its end, or what was asked over it.
inline constexpr int kEnd = 1000, kPolicy = 1008;

/// What a page wants of a stream.
struct Wanted {
  Form form = Form::Raw;
  int width = 0;    ///< elements in a row at most, 0: all
  double rate = 0;  ///< messages a second at most, 0: all
};

/// "as=jpeg&width=400"; Errors: Invalid.
hc::Result<Wanted> parse_wanted(std::string_view options, Wanted wanted = {});

class Stream {
 public:
  Stream(hc::RunningGraph graph, std::string port, web::Post post);

  // On the server's thread.
  /// Has a page see it until its socket closes, or the stream is at its end. Over that it says `ok`
  /// for each message that it is done with, or what it wants from then on.
  void view(const Wanted& wanted, std::shared_ptr<web::WebSocket> socket);
  /// Ends it for all.
  void close(const std::string& why);
  [[nodiscard]] bool is_viewed() const { return !sockets_.empty(); }

  /// Ends the stream after its last viewer: waits for the image being encoded. From any thread.
  void stop() { tap_.reset(); }

 private:
  using Clock = hc::Tap::Clock;
  static constexpr int kMaxUnderWay = 2;  // messages that a page is not done with

  /// A page, as the stream's thread sees it: without its socket, which has to end on the server's.
  struct Viewer {
    // Guarded by the mutex.
    Wanted wanted;
    int under_way = 0;
    bool has_changed = true;  // what it wants
    // Of the stream's thread.
    std::uint64_t seen = 0;  // number of the newest message it was given
    Clock::time_point due{}, header_due{};
    std::uint64_t frame = 0;  // number of the last frame of VP8 it was given, 0: none
  };
  using Viewers = std::vector<std::shared_ptr<Viewer>>;
  struct Video {
    Vp8Encoder encoder;
    std::uint64_t frames = 0;     // encoded
    Clock::time_point key_due{};  // before, no other key frame is made
  };

  // On the tap's thread.
  /// Gives the newest message to those who are ready for it. @returns  when the next one is.
  Clock::time_point serve();
  void serve_alike(const Wanted& wanted, const Viewers& viewers);
  void end(const std::string& why, bool is_error);
  /// Calls on the server's thread, if the page is still there then.
  void post(const std::shared_ptr<Viewer>& viewer,
            std::function<void(const std::shared_ptr<Viewer>&)> call);
  void close_soon(const std::shared_ptr<Viewer>& viewer, int code, const std::string& why);

  // On the server's thread.
  void hear(const std::shared_ptr<Viewer>& viewer, std::string_view said);
  void close(const std::shared_ptr<Viewer>& viewer, int code, const std::string& why);
  void remove(const std::shared_ptr<Viewer>& viewer);

  const web::Post post_;
  // Of the server's thread.
  std::map<std::shared_ptr<Viewer>, std::shared_ptr<web::WebSocket>> sockets_;
  std::mutex mutex_;
  Viewers viewers_;
  std::string ended_;  // why; empty: it has not
  int ended_as_ = 0;   // the code that says so
  // Of the tap's thread.
  hc::Message newest_;
  std::uint64_t number_ = 0;     // of the newest message; 0: there is none
  std::map<int, Video> videos_;  // by width
  std::optional<hc::Tap> tap_;   // last: its thread calls the above
};
