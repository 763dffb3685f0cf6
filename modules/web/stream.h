// SPDX-License-Identifier: Apache-2.0
#pragma once
// An output of the graph for pages (spec/page.md, section 4): observed once, encoded once for all
// pages with the same options. A page gets the newest message when it is ready.

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

/// Close codes: the stream has ended; the request was invalid.
inline constexpr int kEnd = 1000, kPolicy = 1008;

/// A page's options for a stream.
struct Wanted {
  Form form = Form::Raw;
  int width = 0;    ///< maximum elements in a row, 0: all
  double rate = 0;  ///< maximum [Hz], 0: unlimited
};

/// Reads "as=jpeg&width=400". Errors: Invalid.
hc::Result<Wanted> parse_wanted(std::string_view options, Wanted wanted = {});

class Stream {
 public:
  Stream(hc::RunningGraph graph, std::string port, web::Post post);

  // On the server's thread.
  /// Serves a page until its socket closes or the stream ends. The page answers each processed
  /// message with `ok`, or sends new options.
  void view(const Wanted& wanted, std::shared_ptr<web::WebSocket> socket);
  /// Ends it for all pages.
  void close(const std::string& why);
  [[nodiscard]] bool is_viewed() const { return !sockets_.empty(); }

  /// Ends the stream after its last viewer; waits for the image being encoded. From any thread.
  void stop() { tap_.reset(); }

 private:
  using Clock = hc::Tap::Clock;
  static constexpr int kMaxUnderWay = 2;  // messages sent but not yet processed by a page

  /// A page. Its socket is separate, since it must be destroyed on the server's thread.
  struct Viewer {
    // Guarded by the mutex.
    Wanted wanted;
    int under_way = 0;
    bool has_changed = true;  // `wanted`
    // Of the stream's thread.
    std::uint64_t seen = 0;  // number of the last message sent to it
    Clock::time_point due{}, header_due{};
    std::uint64_t frame = 0;  // number of the last VP8 frame sent to it, 0: none
  };
  using Viewers = std::vector<std::shared_ptr<Viewer>>;
  struct Video {
    Vp8Encoder encoder;
    std::uint64_t frames = 0;     // encoded
    Clock::time_point key_due{};  // earliest time of the next key frame
  };

  // On the tap's thread.
  /// Sends the newest message to pages that are ready. @returns  when the next page is due.
  Clock::time_point serve();
  void serve_alike(const Wanted& wanted, const Viewers& viewers);
  void end(const std::string& why, bool is_error);
  /// Calls on the server's thread, unless the page has closed by then.
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
  std::string ended_;  // reason; empty while running
  int ended_as_ = 0;   // close code
  // Of the tap's thread.
  hc::Message newest_;
  std::uint64_t number_ = 0;     // of the newest message; 0: none yet
  std::map<int, Video> videos_;  // by width
  std::optional<hc::Tap> tap_;   // last: its thread calls the above
};
