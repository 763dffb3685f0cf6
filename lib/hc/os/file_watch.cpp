// SPDX-License-Identifier: Apache-2.0
#include <hc/os/file_watch.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>

#include <hc/os/event.h>
#include <hc/os/file_stamp.h>
#include <hc/os/thread.h>

namespace hc {

/// Shared with the thread, which may outlive the FileWatch.
struct FileWatch::Shared {
  Event changed;
  std::mutex mutex;  // guards the members below
  std::condition_variable woken;
  bool is_over = false;
  int sets = 0;  // number of set_files() calls
  // As of the last callback; nullopt: not checked yet.
  std::map<std::string, std::optional<FileStamp>> known;

  void look_until_over() {
    std::unique_lock lock(mutex);
    auto seen = known;
    auto pause = kPeriod;
    int sets_seen = 0;
    while (true) {
      woken.wait_for(lock, pause, [&] { return is_over || sets != sets_seen; });
      if (is_over) return;
      auto now = known;
      sets_seen = sets;
      lock.unlock();
      for (auto& [file, stamp] : now) stamp = file_stamp(file);
      lock.lock();
      if (sets != sets_seen) continue;
      for (auto& [file, stamp] : known)
        if (!stamp) stamp = now[file];
      const bool is_quiet = std::exchange(seen, now) == now;
      pause = is_quiet ? kPeriod : kQuiet;
      if (!is_quiet || now == known) continue;
      known = std::move(now);
      changed.raise();
    }
  }
};

Result<std::unique_ptr<FileWatch>> FileWatch::make(Loop& loop,
                                                   const std::vector<std::string>& files,
                                                   std::function<void()> changed) {
  auto shared = std::make_shared<Shared>();
  shared->changed = HC_TRY(Event::make());
  for (const auto& file : files) shared->known[file] = file_stamp(file);
  std::unique_ptr<FileWatch> made(new FileWatch(shared));
  made->changed_ =
      HC_TRY(loop.watch(shared->changed.descriptor(), EPOLLIN,
                        [event = &shared->changed, changed = std::move(changed)](auto) {
                          event->clear();
                          changed();
                        }));
  auto thread = HC_TRY(start_thread([shared] { shared->look_until_over(); }));
  thread.detach();
  return made;
}

FileWatch::~FileWatch() {
  const std::lock_guard lock(shared_->mutex);
  shared_->is_over = true;
  shared_->woken.notify_all();
}

void FileWatch::set_files(const std::vector<std::string>& files) {
  const std::lock_guard lock(shared_->mutex);
  const auto before = std::exchange(shared_->known, {});
  for (const auto& file : files) {
    const auto found = before.find(file);
    shared_->known[file] = found == before.end() ? std::nullopt : found->second;
  }
  ++shared_->sets;
  shared_->woken.notify_all();
}

bool FileWatch::was_there(const std::string& file) const {
  const std::lock_guard lock(shared_->mutex);
  const auto known = shared_->known.find(file);
  return known == shared_->known.end() || known->second != FileStamp{};
}

}  // namespace hc
