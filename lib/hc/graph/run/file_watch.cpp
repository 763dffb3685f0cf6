// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/file_watch.h>

#include <sys/inotify.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>

namespace hc::internal {

Result<std::unique_ptr<FileWatch>> FileWatch::make(EventLoop& loop, std::function<void()> changed) {
  auto notes =
      system_call("inotify_init1", "", [] { return ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC); });
  if (!notes) return notes.error();
  std::unique_ptr<FileWatch> files(new FileWatch(loop, Descriptor(*notes), std::move(changed)));
  auto watched = loop.watch(*notes, EPOLLIN, [self = files.get()] { self->read(); });
  if (!watched) return watched.error();
  files->watch_ = std::move(*watched);
  return files;
}

void FileWatch::set_files(const std::vector<std::string>& files) {
  std::map<int, std::set<std::string>> folders;
  for (const auto& file : files) {
    const std::filesystem::path path(file);
    const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
    // A folder that is watched already keeps its number.
    int number = ::inotify_add_watch(notes_.get(), folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO);
    if (number >= 0) folders[number].insert(path.filename().string());
  }
  for (const auto& [number, names] : folders_)
    if (!folders.contains(number)) ::inotify_rm_watch(notes_.get(), number);
  folders_ = std::move(folders);
}

void FileWatch::read() {
  alignas(inotify_event) std::array<char, 4096> notes;
  ssize_t size = 0;
  bool is_ours = false;
  while ((size = ::read(notes_.get(), notes.data(), notes.size())) > 0) {
    for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
      inotify_event note;
      std::memcpy(&note, notes.data() + at, sizeof note);
      const char* name = notes.data() + at + offsetof(inotify_event, name);
      auto folder = folders_.find(note.wd);
      is_ours =
          is_ours || (note.len > 0 && folder != folders_.end() && folder->second.contains(name));
      at += sizeof note + note.len;
    }
  }
  if (is_ours) timer_ = loop_.call_at(std::chrono::steady_clock::now() + kQuiet, changed_);
}

}  // namespace hc::internal
