// SPDX-License-Identifier: Apache-2.0
#include <hc/os/file_watch.h>

#include <sys/inotify.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

namespace hc::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kEvents = IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE | IN_DELETE |
                                  IN_MOVED_FROM | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
constexpr int kMostLinks = 8;  // that lead to one another

}  // namespace

Result<std::unique_ptr<FileWatch>> FileWatch::make(Loop& loop, std::function<void()> changed) {
  auto notes =
      system_call("inotify_init1", "", [] { return ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC); });
  if (!notes) return notes.error();
  std::unique_ptr<FileWatch> files(new FileWatch(loop, Descriptor(*notes), std::move(changed)));
  auto watched = loop.watch(*notes, EPOLLIN, [self = files.get()](auto) { self->read(); });
  if (!watched) return watched.error();
  files->watch_ = std::move(*watched);
  return files;
}

void FileWatch::set_files(const std::vector<std::string>& files) {
  files_ = files;
  set_watches();
}

void FileWatch::set_watches() {
  auto before = std::exchange(folders_, {});
  for (const auto& file : files_) follow(file, kMostLinks);
  for (const auto& [number, folder] : before)
    if (!folders_.contains(number)) ::inotify_rm_watch(notes_.get(), number);
}

/// Watches a file, and all links by which it is reached.
void FileWatch::follow(const fs::path& path, int most) {
  watch(path);
  if (most == 0) return;
  for (fs::path each = path; each.has_filename(); each = each.parent_path()) {
    std::error_code is_none;
    const fs::path target = fs::read_symlink(each, is_none);
    if (is_none) continue;
    if (each != path) watch(each);
    follow(each.parent_path() / target, most - 1);
  }
}

/// Watches the folder for what has this name in it; where that is not there, the one for the
/// folder.
void FileWatch::watch(fs::path path) {
  while (path.has_filename()) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
    // A folder that is watched already keeps its number.
    int number = ::inotify_add_watch(notes_.get(), folder.c_str(), kEvents);
    if (number >= 0) {
      folders_[number].path = folder;
      folders_[number].names.insert(path.filename().string());
      return;
    }
    path = path.parent_path();
  }
}

bool FileWatch::is_ours(const inotify_event& note, const char* name) const {
  if ((note.mask & IN_Q_OVERFLOW) != 0) return true;  // what was lost may have been
  auto found = folders_.find(note.wd);
  if (found == folders_.end()) return false;
  if ((note.mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED)) != 0) return true;
  const auto& [path, names] = found->second;
  if (note.len == 0 || !names.contains(name)) return false;
  // A file that has been made is still to be written; a link is whole.
  std::error_code missing;
  return (note.mask & IN_CREATE) == 0 || (note.mask & IN_ISDIR) != 0 ||
         fs::is_symlink(path / name, missing);
}

void FileWatch::read() {
  alignas(inotify_event) std::array<char, 4096> notes;
  ssize_t size = 0;
  bool is_any_ours = false;
  while ((size = ::read(notes_.get(), notes.data(), notes.size())) > 0) {
    for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
      inotify_event note;
      std::memcpy(&note, notes.data() + at, sizeof note);
      const char* name = notes.data() + at + offsetof(inotify_event, name);
      is_any_ours = is_any_ours || is_ours(note, name);
      at += sizeof note + note.len;
    }
  }
  if (!is_any_ours) return;
  timer_ = loop_.call_at(std::chrono::steady_clock::now() + kQuiet, [this] {
    set_watches();  // it may have been a folder, or a link
    changed_();
  });
}

}  // namespace hc::internal
