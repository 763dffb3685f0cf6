// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records streams into a folder: a file STREAM.mtp for each, of its messages and nothing else.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <hc/module/port.h>

/// Writes as messages come. Ends at the first failure: then all files hold whole messages alone.
class FolderRecorder {
 public:
  /// Makes the folder where it is not there. Where it holds one of these files, which an earlier
  /// process of the module has written, it is FOLDER_2 instead, and so on.
  /// @param streams  names of files, each another.
  ///
  /// Errors: Invalid (names that cannot be those of files), System.
  static hc::Result<std::unique_ptr<FolderRecorder>> make(const std::string& folder,
                                                          const std::vector<std::string>& streams);

  /// Errors: System (the disk, with the file's path); each later call gives the same.
  hc::Status record(std::size_t stream, const hc::Message& message);

  /// Writes what is left. Errors: System; also what went wrong before.
  hc::Status close();

  /// Where the files are.
  [[nodiscard]] const std::string& folder() const { return folder_; }
  /// Messages that record() was given.
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  /// Those of them that are in no file; after close().
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  struct Stream {
    std::string path;
    std::unique_ptr<hc::Sink> sink;  // null: closed
  };

  explicit FolderRecorder(std::string folder) : folder_(std::move(folder)) {}

  const std::string folder_;
  std::vector<Stream> streams_;
  hc::Status status_;
  std::uint64_t messages_ = 0, lost_ = 0;
};
