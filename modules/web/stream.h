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
#include <string>
#include <utility>
#include <vector>

#include <client/tap.h>
#include <web/server.h>

#include "encoder.h"

namespace web = hc::web;

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
  /// Called on the server's thread.
  struct Callbacks {
    std::function<void(std::string header)> header;  ///< as it was sent
    std::function<void(web::Bytes)> message;
    /// The stream is at its end. @param is_error  there is no such output, or it failed.
    std::function<void(const std::string& why, bool is_error)> end;
  };
  /// A page that sees a stream; unsees it when it is destroyed.
  class Viewer;

  Stream(hc::RunningGraph graph, std::string port, web::Post post);

  [[nodiscard]] std::unique_ptr<Viewer> view(const Wanted& wanted, Callbacks callbacks);
  [[nodiscard]] bool is_viewed();

 private:
  using Clock = hc::Tap::Clock;
  static constexpr int kMaxUnderWay = 2;  // messages that a page is not done with

  /// A page, as the stream sees it.
  struct Seat {
    // Guarded by the mutex.
    Wanted wanted;
    int under_way = 0;
    bool has_changed = true;  // what it wants
    // Of the stream's thread.
    std::uint64_t seen = 0;  // number of the newest message it was given
    Clock::time_point due{}, header_due{};
    std::uint64_t frame = 0;  // number of the last frame of VP8 it was given, 0: none
    // Of the server's thread.
    Callbacks callbacks;
  };
  using Seats = std::vector<std::shared_ptr<Seat>>;
  struct Video {
    Vp8Encoder encoder;
    std::uint64_t frames = 0;     // encoded
    Clock::time_point key_due{};  // before, no other key frame is made
  };

  // On the tap's thread.
  /// Gives the newest message to those who are ready for it. @returns  when the next one is.
  Clock::time_point serve();
  void serve_alike(const Wanted& wanted, const Seats& seats);
  /// Calls a page on the server's thread, if it is still there then.
  void call(const std::shared_ptr<Seat>& seat, std::function<void(const Callbacks&)> what) const;
  void end(const std::string& why, bool is_error);

  const web::Post post_;
  std::mutex mutex_;
  Seats seats_;
  std::string ended_;  // why; empty: it has not
  bool is_error_ = false;
  // Of the tap's thread.
  hc::Message newest_;
  std::uint64_t number_ = 0;     // of the newest message; 0: there is none
  std::map<int, Video> videos_;  // by width
  hc::Tap tap_;                  // last: its thread calls the above
};

class Stream::Viewer {
 public:
  Viewer(Stream& stream, std::shared_ptr<Seat> seat) : stream_(stream), seat_(std::move(seat)) {}
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// The page is done with a message.
  void acknowledge();
  [[nodiscard]] Wanted wanted() const;
  void want(const Wanted& wanted);

 private:
  Stream& stream_;
  std::shared_ptr<Seat> seat_;
};
