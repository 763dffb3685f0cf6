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

  /// Errors: as open_source(), System.
  static Result<std::unique_ptr<Intake>> make(Loop& loop, const std::string& uri, Take take,
                                              const LinkOptions& options = {});

  /// Takes what is there now.
  void take();

 private:
  static constexpr int kMostInATurn = 256;

  Intake(Loop& loop, std::unique_ptr<Source> source, Take take)
      : loop_(loop), source_(std::move(source)), take_(std::move(take)) {}

  Loop& loop_;
  std::unique_ptr<Source> source_;
  Take take_;
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
