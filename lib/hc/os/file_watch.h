// SPDX-License-Identifier: Apache-2.0
#pragma once
// Notices that files are edited.

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hc/os/loop.h>

namespace hc {

/// Calls when one of some files has been written or taken away, or another put in its place, and
/// nothing more happens to them: what comes in quick succession is one call. It looks at them,
/// since not every file system announces what others do, and they may be reached by links. It looks
/// on a thread of its own, which is left behind where the system does not let a look end, as on a
/// network disk that hangs.
class FileWatch {
 public:
  /// How often it looks, and how long nothing more is to happen before the call.
  static constexpr std::chrono::milliseconds kPeriod{200}, kQuiet{50};

  /// Watches these; waits for a first look at them.
  ///
  /// Errors: System (no descriptor or thread to be had).
  static Result<std::unique_ptr<FileWatch>> make(Loop& loop, const std::vector<std::string>& files,
                                                 std::function<void()> changed);
  ~FileWatch();

  /// Watches these from now on, those that it has watched before from its last call on, and no
  /// others any more. Others are looked at at once, on its thread.
  void set_files(const std::vector<std::string>& files);

  /// Whether a file that it watches was there at its last call.
  [[nodiscard]] bool was_there(const std::string& file) const;

 private:
  struct Shared;
  explicit FileWatch(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

  std::shared_ptr<Shared> shared_;
  Loop::Handle changed_;
};

}  // namespace hc
