// SPDX-License-Identifier: Apache-2.0
#pragma once
// Takes messages from a link as they come, on the thread of a loop. Internal.

#include <functional>
#include <memory>
#include <string>

#include <hc/link/link.h>
#include <hc/os/loop.h>

namespace hc::internal {

/// Hands on all messages of a link until it ends; a busy link leaves turns to others.
class Intake {
 public:
  using Take = std::function<void(const Message& message)>;

  /// @param is_limited  a writer that sends more than kMostInATurn messages in kPause waits.
  /// Errors: as open_source(), System.
  static Result<std::unique_ptr<Intake>> make(Loop& loop, const std::string& uri, Take take,
                                              const LinkOptions& options = {},
                                              bool is_limited = true);

  /// Takes all that has been sent, also by a peer that has just connected.
  void take_rest();
  /// Has `end` called when the link has ended or failed, as the last act of this object, which it
  /// may destroy.
  void on_end(std::function<void()> end) { end_ = std::move(end); }

 private:
  static constexpr int kMostInATurn = 32, kMostRests = 32;
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
  Loop::Handle watch_, woken_, again_;
};

}  // namespace hc::internal
