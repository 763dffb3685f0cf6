// SPDX-License-Identifier: Apache-2.0
#pragma once
// Takes what comes over a link, as it comes, on the thread of a loop. Internal to graph.

#include <functional>
#include <memory>
#include <string>

#include <hc/link/link.h>
#include <hc/os/loop.h>

namespace hc::internal {

/// Hands on all messages of a link until it ends; a link that never ends lets others have a turn.
class Intake {
 public:
  using Take = std::function<void(const Message& message)>;

  /// @param is_limited  whoever sends more than kMostInATurn messages in kPause waits.
  /// Errors: as open_source(), System.
  static Result<std::unique_ptr<Intake>> make(Loop& loop, const std::string& uri, Take take,
                                              const LinkOptions& options = {},
                                              bool is_limited = true);

  /// Takes what is there now.
  void take();

 private:
  static constexpr int kMostInATurn = 32;
  static constexpr std::chrono::milliseconds kPause{10};

  Intake(Loop& loop, std::unique_ptr<Source> source, Take take, bool is_limited)
      : loop_(loop),
        source_(std::move(source)),
        take_(std::move(take)),
        pause_(is_limited ? kPause : std::chrono::milliseconds(0)) {}
  void take_unless_paused();

  Loop& loop_;
  std::unique_ptr<Source> source_;
  Take take_;
  const std::chrono::milliseconds pause_;
  bool is_paused_ = false;
  Loop::Handle watch_, woken_, again_;
};

/// What reads in the place of a module that reads no more, so that no writer waits for it.
///
/// @param reader_uri  the URI of its end; how long it was to wait plays no part, and it keeps no
///     message from being overwritten.
///
/// Errors: as Intake::make.
Result<std::unique_ptr<Intake>> make_drain(Loop& loop, const std::string& reader_uri);

}  // namespace hc::internal
