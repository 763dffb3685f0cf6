// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lines for a person, who may not read them: a pager shows its first page, a terminal is held by
// Ctrl-S. Who says them does not wait.

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

namespace tool {

/// Writes lines to a descriptor on a thread of its own, and below them one that changes. Where too
/// many wait, more are dropped, and a line says how many when there is room again.
class Outbox {
 public:
  static constexpr std::size_t kMostWaiting = std::size_t{1} << 20;  ///< [byte]
  /// How long finish() waits for who reads nothing at all.
  static constexpr std::chrono::milliseconds kPatience{1000};

  explicit Outbox(int descriptor);
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void say(std::string_view line);
  /// Has the line below the others replaced, as it is now; empty: there is none.
  void show(std::string below);
  /// Takes the line below away, and waits until all is written, as long as somebody reads.
  void finish();

 private:
  struct Shared;

  std::shared_ptr<Shared> shared_;  // with the thread, which may be left behind in a write
  std::thread writer_;
  std::size_t unread_ = ~std::size_t{0};  // how many pieces were written when nobody read more
};

}  // namespace tool
