// SPDX-License-Identifier: Apache-2.0
#pragma once
// Notices that files are edited.

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hc/os/loop.h>

namespace hc {

/// Calls when one of some files has been written or taken away, or another put in its place, and
/// nothing more happens to them: what comes in quick succession is one call. It looks at them,
/// since not every file system announces what others do, and they may be reached by links.
class FileWatch {
 public:
  /// How often it looks, and how long nothing more is to happen before the call.
  static constexpr std::chrono::milliseconds kPeriod{200}, kQuiet{50};

  FileWatch(Loop& loop, std::function<void()> changed)
      : loop_(loop), changed_(std::move(changed)) {}

  /// Watches these from now on, those that it has watched before from its last call on, and no
  /// others any more.
  void set_files(const std::vector<std::string>& files);

 private:
  /// What tells one state of a file from another; all 0: there is none.
  struct Stamp {
    dev_t device = 0;
    ino_t number = 0;
    off_t size = 0;
    std::int64_t written = 0, written_ns = 0;
    bool operator==(const Stamp&) const = default;
  };
  using Stamps = std::map<std::string, Stamp>;

  static Stamp stamp_of(const std::string& file);
  void look();

  Loop& loop_;
  std::function<void()> changed_;
  Stamps known_, seen_;  // at the last call, and at the last look
  Loop::Handle timer_;
};

}  // namespace hc
