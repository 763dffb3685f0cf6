// SPDX-License-Identifier: Apache-2.0
#pragma once
// Log output that never blocks its writer: the reader may be a pager at its first page, or a
// terminal held by Ctrl-S.

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

namespace tool {

/// Writes lines to a descriptor on its own thread, and a status line below them. When the queue is
/// full, lines are dropped; one line says how many when there is room again.
class Outbox {
 public:
  static constexpr std::size_t kMostWaiting = std::size_t{1} << 20;  ///< [byte]
  /// How long finish() waits for a reader that reads nothing.
  static constexpr std::chrono::milliseconds kPatience{1000};

  explicit Outbox(int descriptor);
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void say(std::string_view line);
  /// Replaces the status line; empty removes it.
  void show(std::string below);
  /// Removes the status line, and waits until all is written, as long as the reader makes progress.
  void finish();

 private:
  struct Shared;

  std::shared_ptr<Shared> shared_;        // with the thread, which may stay blocked in a write
  std::size_t unread_ = ~std::size_t{0};  // the number of pieces when the reader stopped reading
};

}  // namespace tool
