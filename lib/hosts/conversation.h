// SPDX-License-Identifier: Apache-2.0
#pragma once
// The protocol between `hc run` and `hc agent` over ssh: MTP messages. Internal.
//
// The src of a message is its kind, its dst the number of a module. Commands and reports of modules
// (spec/module.md) are forwarded unchanged.
//
// src      from    content
// 1        both    an order, answer, event or heartbeat: a string, one line of JSON
// 2        runner  commands for a module
// 3        agent   a module's output to standard error: bytes
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

/// Period of heartbeats, and silence after which the connection is lost.
inline constexpr std::chrono::milliseconds kHeartbeat{500}, kSilence{3000};
/// A clock that jumps by more was set.
inline constexpr std::chrono::milliseconds kClockSet{10};
/// Unsent bytes above which counters and logs are dropped, and above which the connection is lost.
inline constexpr std::size_t kCrowded = std::size_t{256} << 10, kTooMuch = std::size_t{16} << 20;

/// The times of a heartbeat [ns]: when the runner sent it, when the agent received it and answered
/// (both monotonic), and the agent's offset from its monotonic to its wall clock. The first two are
/// 0 in heartbeats that are not answers.
using Moments = std::array<std::int64_t, 4>;
/// Usage of a module's processes: number of the module, PID, CPU time [ns], memory [byte], whether
/// it is stopped by a signal or a debugger, whether by a debugger, and for how long it has waited
/// for a processor [ns].
using UsageRow = std::array<std::int64_t, 7>;

Message make_order(const Json& order);
/// Parses an object with a string "what"; null if the message is not an order.
Json read_order(const Message& message);
Message make_bytes(std::string_view bytes, std::int64_t process);

/// The monotonic clock, and the offset from it to the wall clock.
MonotonicTime monotonic_now();
std::chrono::nanoseconds monotonic_to_wall();

/// One end of the conversation, on the thread of a loop.
class Conversation {
 public:
  struct Callbacks {
    std::function<void(const Message& message)> take;
    /// The connection has ended; called once, never within send(). Must not destroy this object.
    std::function<void(const std::string& why)> ended;
  };

  /// Prefix of the reason if the input is not MTP.
  static constexpr std::string_view kNoMessage = "not an MTP message";
  /// The reason if the other end has closed the connection.
  static constexpr std::string_view kEnded = "the connection has ended";

  /// @param in, out  non-blocking descriptors that outlive this object.
  /// @param patience  time for the first message.
  /// Errors: System.
  static Result<std::unique_ptr<Conversation>> make(Loop& loop, int in, int out,
                                                    std::chrono::milliseconds patience,
                                                    Callbacks callbacks);

  void send(const Message& message);
  /// Stops taking and sending messages, without calling `ended`.
  void close();
  /// Unsent bytes.
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
