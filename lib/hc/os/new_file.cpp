// SPDX-License-Identifier: Apache-2.0
#include <hc/os/new_file.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include <hc/base/backoff.h>
#include <hc/os/program.h>

namespace hc {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kPatience{2};  // to wait for another process that writes the file
constexpr mode_t kPublic = 0666, kPrivate = 0600;
constexpr const char* kIsWritten = ": another process is writing it";

Result<Descriptor> open_file(const std::string& path, int flags, mode_t mode = kPublic) {
  return open_descriptor("open", path, [&] {
    return ::open(path.c_str(), flags | O_CREAT | O_CLOEXEC | O_NOCTTY, mode);
  });
}

/// Locks a file for writing; false if another process has the lock. Succeeds without a lock where
/// the file system has none.
bool lock(const Descriptor& file) {
  return ::flock(file.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

/// Whether the path still leads to the open file.
bool is_at(const Descriptor& file, const std::string& path) {
  struct stat open {
  }, named{};
  return ::fstat(file.get(), &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

bool has_contents(const std::string& path) {
  struct stat about {};
  return ::stat(path.c_str(), &about) == 0 && about.st_size > 0;
}

/// Whether other users can read or write an open file, or own it.
bool is_accessible_to_others(const Descriptor& file) {
  struct stat about {};
  return ::fstat(file.get(), &about) != 0 || about.st_uid != ::geteuid() ||
         (about.st_mode & (S_IRWXG | S_IRWXO)) != 0;
}

/// Opens PATH empty and locked, to be renamed over another file when it is written.
Result<Descriptor> open_successor(const std::string& path, mode_t mode) {
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  Backoff pause(std::chrono::milliseconds(1));
  while (true) {
    // Another user may have put a symbolic link or a FIFO there.
    auto file = HC_TRY(open_file(path, O_WRONLY | O_NOFOLLOW | O_NONBLOCK, mode));
    // The previous writer may have renamed the file.
    if (lock(file) && is_at(file, path)) {
      if (::ftruncate(file.get(), 0) != 0) return system_error("ftruncate", path);
      return file;
    }
    const auto now = std::chrono::steady_clock::now();
    if (now > give_up) return Error{Code::System, path + kIsWritten};
    HC_TRY(wait_for(-1, 0, -1, std::min(now + pause.next(), give_up)));
  }
}

Status write_to(const Descriptor& file, const std::string& path, std::string_view contents) {
  const auto done = write_all(file.get(), contents);
  return done ? done : Error{done.error().code, path + ": " + done.error().detail};
}

Status put_in_place(const std::string& path, std::string_view contents, mode_t mode,
                    bool replaces) {
  const std::string unfinished = path + ".unfinished";
  const auto file = HC_TRY(open_successor(unfinished, mode));
  const bool is_wanted = replaces || ::access(path.c_str(), F_OK) != 0;
  if (is_wanted && mode == kPrivate && is_accessible_to_others(file))
    return Error{Code::System, unfinished +
                                   ": other users can read it; remove it, or "
                                   "choose a file system that has permissions"};
  Status done = is_wanted ? write_to(file, path, contents) : Status();
  if (done && is_wanted && std::rename(unfinished.c_str(), path.c_str()) != 0)
    done = system_error("rename", path);
  if (!done || !is_wanted) ::unlink(unfinished.c_str());
  return done;
}

}  // namespace

bool is_written_in_place(const std::string& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode)) return true;
  std::error_code none;
  auto is_of_a_process = [](const fs::path& each) { return each.string().starts_with("/proc/"); };
  return is_of_a_process(fs::weakly_canonical(fs::absolute(path, none).parent_path(), none)) ||
         is_of_a_process(fs::read_symlink(path, none));
}

std::string free_name(const std::string& path, std::string_view ending,
                      const std::function<bool(const std::string& path)>& is_free) {
  if (!path.ends_with(ending)) ending = "";
  std::string stem = path.substr(0, path.size() - ending.size());
  std::error_code none;
  auto strip = [&stem] {  // "kept/"
    while (stem.size() > 1 && stem.ends_with('/')) stem.pop_back();
  };
  strip();
  if (const auto last = fs::path(stem).filename(); last == "." || last == "..")
    stem = fs::weakly_canonical(fs::absolute(stem, none), none).string();
  strip();
  std::string name = path;
  for (int i = 2; !is_free(name); ++i) name = stem + "_" + std::to_string(i) + std::string(ending);
  return name;
}

Result<NewFile> begin_file(const std::string& path) {
  if (is_written_in_place(path)) {
    auto opened = HC_TRY(open_file(path, O_WRONLY | O_APPEND));
    return NewFile{std::move(opened), path};
  }
  // Of two processes that find the same empty file, the lock decides which one gets it.
  Result<Descriptor> file = Descriptor();
  bool is_new = false;
  auto name = free_name(path, fs::path(path).extension().string(), [&](const std::string& each) {
    if (has_contents(each)) return false;
    file = open_file(each, O_WRONLY | O_EXCL);
    is_new = file.has_value();
    if (!file) file = open_file(each, O_WRONLY);
    return !file || (lock(*file) && !has_contents(each));
  });
  if (!file) return file.error();
  return NewFile{std::move(*file), std::move(name), is_new};
}

Result<NewFile> continue_file(const std::string& path) {
  auto file = HC_TRY(open_file(path, O_RDWR));
  if (!lock(file)) return Error{Code::System, path + kIsWritten};
  return NewFile{std::move(file), path};
}

Status replace_file(const std::string& path, std::string_view contents) {
  if (!is_written_in_place(path)) return put_in_place(path, contents, kPublic, true);
  return write_to(HC_TRY(open_file(path, O_WRONLY)), path, contents);
}

Status replace_private_file(const std::string& path, std::string_view contents) {
  return put_in_place(path, contents, kPrivate, true);
}

Status make_private_file(const std::string& path, std::string_view contents) {
  return put_in_place(path, contents, kPrivate, false);
}

}  // namespace hc
