// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `hc run` and `hc agent` say to each other, over ssh: messages of MTP. Internal.
//
// The kind of a message is its src; its dst is the number of the module that it is about. Commands
// and reports are those of the module (spec/module.md), as they are.
//
// src      from    what
// 1        both    an order, an answer, an event, or a heartbeat: a string, one line of JSON
// 2        runner  commands for a module
// 3        agent   what a module has written to its standard error: bytes
// 100 + s  agent   a module's report with src s

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <hc/mtp/message.h>
#include <hc/mtp/stream_reader.h>
#include <hc/os/loop.h>

namespace hc::hosts {

using Json = nlohmann::json;

enum MessageKind : std::int32_t { Order = 1, Commands, Log, Report = 100 };

/// How often each end speaks, and how long it may be silent before the other gives up.
inline constexpr std::chrono::milliseconds kHeartbeat{500}, kSilence{3000};
/// A clock that jumps so far has been set [ns].
inline constexpr std::int64_t kClockSet = 10'000'000;
/// What may wait to go before what can be spared is dropped, and before the other end is given up.
inline constexpr std::size_t kCrowded = std::size_t{256} << 10, kTooMuch = std::size_t{16} << 20;

/// The times of a heartbeat [ns]: of the runner the moment when it was sent; of the agent that
/// moment again, when it came, when the answer was sent (monotonic), and what to add to that for
/// the wall clock. What the agent says of its own accord has 0 for the first two.
using Moments = std::array<std::int64_t, 4>;
/// What the processes of a module use: its number, process, processor time [ns], memory [byte], and
/// whether it is stopped by a signal.
using UsageRow = std::array<std::int64_t, 5>;

Message make_order(const Json& order);
/// An object with a string "what"; null where the message is no such order.
Json read_order(const Message& message);
Message make_bytes(std::string_view bytes, std::int64_t process);

/// Monotonic clock, and what to add to it for the wall clock [ns].
std::int64_t monotonic_now();
std::int64_t monotonic_to_wall();

/// One end of the conversation, on the thread of a loop.
class Conversation {
 public:
  struct Callbacks {
    std::function<void(const Message& message)> take;
    /// It is over; called once, and not within say(). It may not destroy this object.
    std::function<void(const std::string& why)> ended;
  };

  /// The first words of why it ended when something else than a message came.
  static constexpr std::string_view kNoMessage = "what it says is no message";
  /// Why it ended when the other end closed it.
  static constexpr std::string_view kEnded = "the connection has ended";

  /// @param in, out  descriptors that do not block, and stay open as long as this.
  /// @param patience  how long the first message may take.
  /// Errors: System.
  static Result<std::unique_ptr<Conversation>> make(Loop& loop, int in, int out,
                                                    std::chrono::milliseconds patience,
                                                    Callbacks callbacks);

  void say(const Message& message);
  /// From now on nothing is taken or sent, and `ended` is not called.
  void close();
  /// Bytes that wait to go.
  [[nodiscard]] std::size_t backlog() const { return waiting_.size(); }

 private:
  Conversation(int in, int out, Callbacks callbacks)
      : in_(in), out_(out), callbacks_(std::move(callbacks)) {}

  void read();
  void write();
  void end(const std::string& why);

  int in_, out_;
  Callbacks callbacks_;
  bool is_over_ = false, is_stuck_ = false;
  StreamReader reader_{Limits{std::uint64_t{4} << 20}};
  std::string waiting_;
  std::chrono::steady_clock::time_point heard_;
  std::chrono::milliseconds patience_{0};
  Loop::Handle readable_, writable_, silence_;
};

}  // namespace hc::hosts
