// SPDX-License-Identifier: Apache-2.0
#pragma once
// Notices that files are edited. Internal to graph.

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <hc/graph/run/event_loop.h>

namespace hc::internal {

/// Calls when one of some files has been written, or another put in its place, as most editors do:
/// so it is their folders that are watched. What comes in quick succession is one call.
class FileWatch {
 public:
  /// How long nothing more is to happen before the call.
  static constexpr std::chrono::milliseconds kQuiet{50};

  /// Errors: System.
  static Result<std::unique_ptr<FileWatch>> make(EventLoop& loop, std::function<void()> changed);

  /// Watches these, and no others any more. Folders that are not there are passed over.
  void set_files(const std::vector<std::string>& files);

 private:
  FileWatch(EventLoop& loop, Descriptor notes, std::function<void()> changed)
      : loop_(loop), changed_(std::move(changed)), notes_(std::move(notes)) {}

  void read();

  EventLoop& loop_;
  std::function<void()> changed_;
  Descriptor notes_;                              // of inotify
  std::map<int, std::set<std::string>> folders_;  // names of files, by the number of the watch
  EventLoop::Handle watch_, timer_;
};

}  // namespace hc::internal
