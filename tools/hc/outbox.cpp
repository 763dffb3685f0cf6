// SPDX-License-Identifier: Apache-2.0
#include "outbox.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <hc/base/format.h>
#include <hc/base/visible.h>
#include <hc/os/program.h>
#include <hc/os/thread.h>

#include "common.h"

namespace tool {

struct Outbox::Shared {
  explicit Shared(int number) : descriptor(number) {}

  const int descriptor;
  std::mutex mutex;
  std::condition_variable changed;
  std::string queued;       // lines
  std::size_t dropped = 0;  // lines after those
  std::string status;
  bool is_status_new = false, is_status_drawn = false;
  bool is_writing = false, is_ending = false;
  std::size_t pieces = 0;  // written so far

  [[nodiscard]] bool has_work() const { return !queued.empty() || dropped > 0 || is_status_new; }
  [[nodiscard]] bool is_done() const { return !has_work() && !is_writing; }

  /// The text to write now.
  std::string take() {
    constexpr const char* kErase = "\r\033[K";
    std::string text = is_status_drawn ? kErase : "";
    text += std::exchange(queued, {});
    if (dropped > 0) text += hc::format("hc run: {} lines dropped\n", dropped);
    dropped = 0;
    text += status;
    is_status_drawn = !status.empty();
    is_status_new = false;
    return text;
  }

  void write() {
    // Small pieces, to notice progress of the reader.
    constexpr std::size_t kPiece = 4096;
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [this] { return has_work() || is_ending; });
      if (!has_work()) return;
      const std::string text = take();
      is_writing = true;
      for (std::string_view rest = text; !rest.empty();) {
        const auto piece = rest.substr(0, kPiece);
        rest.remove_prefix(piece.size());
        lock.unlock();
        // Ignores a reader that has closed.
        static_cast<void>(hc::write_all(descriptor, piece));
        lock.lock();
        ++pieces;
        changed.notify_all();
      }
      is_writing = false;
      changed.notify_all();
    }
  }
};

Outbox::Outbox(int descriptor) : shared_(std::make_shared<Shared>(descriptor)) {
  value_or_fail(hc::start_thread([shared = shared_] { shared->write(); })).detach();
}

Outbox::~Outbox() {
  finish();
  const std::lock_guard lock(shared_->mutex);
  shared_->is_ending = true;
  shared_->changed.notify_all();
}

void Outbox::say(std::string_view line) {
  std::lock_guard lock(shared_->mutex);
  if (shared_->dropped > 0 || shared_->queued.size() + line.size() >= kMaxQueued)
    ++shared_->dropped;
  else
    shared_->queued.append(hc::visible(line)).append("\n");
  shared_->changed.notify_all();
}

void Outbox::show(std::string status) {
  std::lock_guard lock(shared_->mutex);
  if (status.empty() && shared_->status.empty()) return;
  shared_->status = std::move(status);
  shared_->is_status_new = true;
  shared_->changed.notify_all();
}

void Outbox::finish() {
  show("");
  std::unique_lock lock(shared_->mutex);
  const auto& shared = *shared_;
  while (!shared.is_done() && shared.pieces != stuck_at_) {
    const std::size_t before = shared.pieces;
    const bool has_moved = shared_->changed.wait_for(
        lock, kPatience, [&] { return shared.pieces != before || shared.is_done(); });
    if (!has_moved) stuck_at_ = before;
  }
}

}  // namespace tool
