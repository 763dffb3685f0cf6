// SPDX-License-Identifier: Apache-2.0
#pragma once
// A loop on a thread of its own. Internal.

#include <csignal>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <hc/os/event.h>
#include <hc/os/loop.h>

namespace hc::hosts {

class Worker {
 public:
  /// Errors: System.
  static Result<std::unique_ptr<Worker>> make() {
    auto loop = internal::Loop::make();
    if (!loop) return loop.error();
    auto posted = internal::Event::make();
    if (!posted) return posted.error();
    std::unique_ptr<Worker> worker(new Worker(std::move(*loop), std::move(*posted)));
    auto watched = worker->loop_->watch(worker->posted_.descriptor(), EPOLLIN,
                                        [self = worker.get()](auto) { self->do_jobs(); });
    if (!watched) return watched.error();
    worker->watch_ = std::move(*watched);
    // Signals are for the program's own threads.
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    worker->thread_ = std::thread([self = worker.get()] {
      while (!self->is_stopped_ && self->loop_->turn()) {
      }
    });
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return worker;
  }
  /// Does what has been posted first.
  ~Worker() {
    post([this] { is_stopped_ = true; });
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Has something done on the thread, in the order of the calls. From any thread.
  void post(std::function<void()> job) {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
    posted_.raise();
  }

  /// For what is done on the thread.
  [[nodiscard]] internal::Loop& loop() { return *loop_; }

 private:
  Worker(std::unique_ptr<internal::Loop> loop, internal::Event posted)
      : loop_(std::move(loop)), posted_(std::move(posted)) {}

  void do_jobs() {
    posted_.clear();
    std::vector<std::function<void()>> jobs;
    {
      const std::lock_guard lock(mutex_);
      jobs.swap(jobs_);
    }
    for (const auto& job : jobs) job();
  }

  std::unique_ptr<internal::Loop> loop_;
  internal::Event posted_;
  std::mutex mutex_;
  std::vector<std::function<void()>> jobs_;
  bool is_stopped_ = false;  // of the thread
  internal::Loop::Handle watch_;
  std::thread thread_;
};

}  // namespace hc::hosts
