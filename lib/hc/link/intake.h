// SPDX-License-Identifier: Apache-2.0
#pragma once
// Receives messages of a link on a loop's thread. Internal.

#include <functional>
#include <memory>
#include <string>

#include <hc/link/link.h>
#include <hc/os/loop.h>

namespace hc::internal {

/// Calls back for each message of a link until it ends; a busy link does not starve the loop.
class Intake {
 public:
  using Take = std::function<void(const Message& message)>;

  /// @param is_limited  delays a writer that sends more than kMaxPerTurn messages within kPause.
  /// Errors: those of open_source(), System.
  static Result<std::unique_ptr<Intake>> make(Loop& loop, const std::string& uri, Take take,
                                              const LinkOptions& options = {},
                                              bool is_limited = true);

  /// Takes all messages sent so far, also by a peer that has just connected.
  void take_rest();
  /// Sets a function to call when the link has ended or failed. It is the object's last action;
  /// `end` may destroy it.
  void on_end(std::function<void()> end) { end_ = std::move(end); }

 private:
  static constexpr int kMaxPerTurn = 32, kMaxRestTurns = 32;
  static constexpr std::chrono::milliseconds kPause{10};

  Intake(Loop& loop, std::unique_ptr<Source> source, Take take, bool is_limited)
      : loop_(loop),
        source_(std::move(source)),
        take_(std::move(take)),
        pause_(is_limited ? kPause : std::chrono::milliseconds(0)) {}
  void take();
  void take_unless_paused();

  Loop& loop_;
  std::unique_ptr<Source> source_;
  Take take_;
  std::function<void()> end_;
  const std::chrono::milliseconds pause_;
  bool is_paused_ = false;
  Loop::Handle watch_, wake_, retry_;
};

}  // namespace hc::internal
