// SPDX-License-Identifier: Apache-2.0
#pragma once
// Detects changes of files.

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hc/os/loop.h>

namespace hc {

/// Calls back when files have been written, removed or replaced and no further change follows;
/// changes in quick succession cause one call. It polls, since some file systems do not report
/// changes made elsewhere and paths may contain symbolic links. It polls on a separate thread,
/// which is abandoned if a system call hangs, as on a network disk.
class FileWatch {
 public:
  /// Polling period, and how long the files must be unchanged before the callback.
  static constexpr std::chrono::milliseconds kPeriod{200}, kQuiet{50};

  /// Starts watching; returns after a first check of the files.
  ///
  /// Errors: System (no descriptor or thread available).
  static Result<std::unique_ptr<FileWatch>> make(Loop& loop, const std::vector<std::string>& files,
                                                 std::function<void()> changed);
  ~FileWatch();

  /// Replaces the set of watched files. Files watched before are compared with their state at the
  /// last callback; new ones are checked at once, on the thread.
  void set_files(const std::vector<std::string>& files);

  /// Whether a watched file existed at the last callback.
  [[nodiscard]] bool was_there(const std::string& file) const;

 private:
  struct Shared;
  explicit FileWatch(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

  std::shared_ptr<Shared> shared_;
  Loop::Handle changed_;
};

}  // namespace hc
