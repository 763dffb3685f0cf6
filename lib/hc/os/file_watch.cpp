// SPDX-License-Identifier: Apache-2.0
#include <hc/os/file_watch.h>

#include <sys/stat.h>

namespace hc {

FileWatch::Stamp FileWatch::stamp_of(const std::string& file) {
  struct stat about {};
  if (::stat(file.c_str(), &about) != 0) return {};
  return {about.st_dev, about.st_ino, about.st_size, about.st_mtim.tv_sec, about.st_mtim.tv_nsec};
}

void FileWatch::set_files(const std::vector<std::string>& files) {
  const auto before = std::exchange(known_, {});
  for (const auto& file : files) {
    const auto found = before.find(file);
    known_[file] = found == before.end() ? stamp_of(file) : found->second;
  }
  look();
}

void FileWatch::look() {
  Stamps now;
  for (const auto& [file, stamp] : known_) now[file] = stamp_of(file);
  const bool is_quiet = std::exchange(seen_, now) == now;
  timer_ = loop_.call_at(std::chrono::steady_clock::now() + (is_quiet ? kPeriod : kQuiet),
                         [this] { look(); });
  if (!is_quiet || now == known_) return;
  known_ = std::move(now);
  changed_();
}

}  // namespace hc
