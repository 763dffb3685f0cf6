// SPDX-License-Identifier: Apache-2.0
#pragma once
// The folder of the people whom the robot knows: a file for each, with the person's name. Its
// content is one message, a table with a view of the face in each row (doc/people.md).

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <hc/os/file_stamp.h>
#include <people/gallery.h>

/// Keeps a gallery as the files are.
class Folder {
 public:
  /// Of each person; the oldest are dropped.
  static constexpr std::size_t kMostViews = 25;
  static constexpr std::size_t kMostPeople = 1000;

  /// @param path  of the folder; "": no person is known or can be learned.
  /// @param log  for a line about a file that cannot be read.
  Folder(std::string path, std::function<void(std::string_view)> log)
      : path_(std::move(path)), log_(std::move(log)) {}

  /// Reads the files that are new or have changed, and forgets the people whose file has gone. If
  /// the folder cannot be read, nothing changes, and the log says why, once.
  /// @returns  whether anything has changed.
  bool read();
  /// Adds views to a person, who may be new, and writes their file. Makes the folder, for its owner
  /// alone, where there is none.
  ///
  /// Errors: Invalid (not a name; no folder is set), System.
  hc::Status learn(const std::string& name, const std::vector<hc::people::Embedding>& views);

  [[nodiscard]] const hc::people::Gallery& gallery() const { return gallery_; }

 private:
  void complain(const std::string& why);
  [[nodiscard]] std::string file_of(const std::string& name) const { return path_ + "/" + name; }

  std::string path_;
  std::function<void(std::string_view)> log_;
  hc::people::Gallery gallery_;
  std::map<std::string, hc::FileStamp> files_;  // as they were read
  std::string complaint_;                       // the last one about the folder
};
