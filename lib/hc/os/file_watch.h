// SPDX-License-Identifier: Apache-2.0
#pragma once
// Notices that files are edited. Internal.

#include <sys/inotify.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <hc/os/loop.h>

namespace hc::internal {

/// Calls when one of some files has been written or taken away, or another put in its place, as
/// most editors do: so it is their folders that are watched, and those of the links that lead
/// there. Folders may come and go. What comes in quick succession is one call.
class FileWatch {
 public:
  /// How long nothing more is to happen before the call.
  static constexpr std::chrono::milliseconds kQuiet{50};

  /// Errors: System.
  static Result<std::unique_ptr<FileWatch>> make(Loop& loop, std::function<void()> changed);

  /// Watches these, and no others any more.
  void set_files(const std::vector<std::string>& files);

 private:
  FileWatch(Loop& loop, Descriptor notes, std::function<void()> changed)
      : loop_(loop), changed_(std::move(changed)), notes_(std::move(notes)) {}

  struct Folder {
    std::filesystem::path path;
    std::set<std::string> names;  // in it, that are of interest
  };

  void set_watches();
  void follow(const std::filesystem::path& path, int most);
  void watch(std::filesystem::path path);
  [[nodiscard]] bool is_ours(const inotify_event& note, const char* name) const;
  void read();

  Loop& loop_;
  std::function<void()> changed_;
  Descriptor notes_;  // of inotify
  std::vector<std::string> files_;
  std::map<int, Folder> folders_;  // by the number of the watch
  Loop::Handle watch_, timer_;
};

}  // namespace hc::internal
