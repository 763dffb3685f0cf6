// SPDX-License-Identifier: Apache-2.0
#pragma once
// Log output that never blocks its caller, even if the reader is a pager or a stopped terminal.

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

namespace tool {

/// Writes lines, and a status line below them, to a descriptor on its own thread. Drops lines when
/// the queue is full, and later writes how many.
class Outbox {
 public:
  static constexpr std::size_t kMaxQueued = std::size_t{1} << 20;  ///< [byte]
  /// Time after which finish() gives up on a reader that reads nothing.
  static constexpr std::chrono::milliseconds kPatience{1000};

  explicit Outbox(int descriptor);
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void say(std::string_view line);
  /// Replaces the status line; empty removes it.
  void show(std::string status);
  /// Removes the status line, and waits until all is written or the reader makes no progress.
  void finish();

 private:
  struct Shared;

  std::shared_ptr<Shared> shared_;          // with the thread, which may block in a write for ever
  std::size_t stuck_at_ = ~std::size_t{0};  // value of `pieces` when the reader stopped reading
};

}  // namespace tool
