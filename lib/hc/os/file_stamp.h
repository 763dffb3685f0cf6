// SPDX-License-Identifier: Apache-2.0
#pragma once
// Identifies the state of a file, to detect changes.

#include <sys/stat.h>
#include <sys/types.h>

#include <cstdint>
#include <string>

namespace hc {

/// The file at a path and its modification time; all 0: no such file.
struct FileStamp {
  dev_t device = 0;
  ino_t number = 0;
  off_t size = 0;
  std::int64_t written = 0, written_ns = 0;
  bool operator==(const FileStamp&) const = default;
};

inline FileStamp file_stamp(const std::string& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0) return {};
  return {about.st_dev, about.st_ino, about.st_size, about.st_mtim.tv_sec, about.st_mtim.tv_nsec};
}

}  // namespace hc
