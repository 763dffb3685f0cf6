// SPDX-License-Identifier: Apache-2.0
#include "live.h"

#include <algorithm>
#include <utility>

namespace {

constexpr std::chrono::milliseconds kTimeout{100};  // of a wait, to notice `stopping_`
constexpr std::chrono::seconds kSettled{1};         // a camera lost sooner increases the backoff
constexpr std::chrono::hours kLongestPeriod{24};
constexpr std::chrono::milliseconds kBurst{500};  // a reader that is behind for longer is too slow
constexpr std::size_t kMostTaken = 8;

}  // namespace

bool Thinning::takes(hc::Time time, double rate) {
  if (rate <= 0) return true;
  const auto period = std::min<hc::MonotonicTime>(hc::duration(1 / rate), kLongestPeriod);
  // The first image, or the clock was set back.
  if (due_ == hc::Time() || due_ - time > 2 * period) due_ = time;
  // A camera that keeps the rate itself may be a little early.
  if (time < due_ - period / 4) return false;
  due_ = std::max(due_, time - period) + period;
  return true;
}

struct LiveCameras::Camera {
  std::size_t side = 0;
  LiveCamera how;
  bool is_missing = false;  // and logged
  std::string remark;       // last logged
  hc::Backoff backoff;
  std::thread thread;
};

LiveCameras::LiveCameras(std::vector<LiveCamera> cameras, bool reopen, const Adjustment& adjustment)
    : reopen_(reopen), adjustment_(adjustment) {
  for (auto& how : cameras) {
    auto camera = std::make_unique<Camera>();
    camera->side = cameras_.size();
    camera->how = std::move(how);
    cameras_.push_back(std::move(camera));
  }
  for (auto& camera : cameras_) camera->thread = std::thread([this, &camera] { run(*camera); });
}

LiveCameras::~LiveCameras() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (auto& camera : cameras_) camera->thread.join();
}

void LiveCameras::report(std::string text) {
  const std::lock_guard lock(mutex_);
  remarks_.push_back({hc::Level::Warning, std::move(text)});
}

/// Waits; false when stopping.
bool LiveCameras::pause(std::chrono::nanoseconds time) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, time, [&] { return stopping_; });
  return !stopping_;
}

/// Handles a camera that cannot be opened or is lost. Caller holds the mutex.
void LiveCameras::miss(Camera& camera, const hc::Error& why, const char* how, const char* then) {
  if (!reopen_)
    failure_ = hc::Error{why.code, camera.how.name + ": " + why.detail};
  else if (!camera.is_missing)
    remarks_.push_back({hc::Level::Warning, camera.how.name + how + why.detail + then});
  camera.is_missing = true;
}

void LiveCameras::run(Camera& camera) {
  do {
    auto device = camera.how.open();
    if (device) {
      const std::string remark = (*device)->remark();
      if (remark != std::exchange(camera.remark, remark) && !remark.empty())
        report(camera.how.name + ": " + remark);
      serve(camera, **device);
    } else {
      const std::lock_guard lock(mutex_);
      miss(camera, device.error(), ": cannot connect: ", "; retrying");
    }
    {
      const std::lock_guard lock(mutex_);
      pairing_.clear(camera.side);
      if (failure_) stopping_ = true;
    }
    changed_.notify_all();
    const auto now = hc::SystemClock().monotonic();
    camera.backoff.fail(now);
    if (!pause(camera.backoff.due() - now)) return;
  } while (true);
}

/// Takes a camera's images until it is lost or we stop.
void LiveCameras::serve(Camera& camera, Device& device) {
  std::optional<Adjustment> adjusted;
  std::optional<std::chrono::steady_clock::time_point> first;
  while (true) {
    Adjustment wanted;
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return;
      wanted = adjustment_;
    }
    if (wanted != adjusted) {
      adjusted = wanted;
      if (auto done = device.adjust(wanted); !done)
        report(camera.how.name + ": " + done.error().detail);
    }
    auto frame = device.next(kTimeout);
    if (frame && !*frame) continue;
    const std::lock_guard lock(mutex_);
    if (!frame) return miss(camera, frame.error(), ": disconnected: ", "; reconnecting");
    const auto now = std::chrono::steady_clock::now();
    if (first && now - *first > kSettled) camera.backoff.reset();
    if (!first) {
      // Connected means that an image arrives, not merely that the device opens.
      first = now;
      if (std::exchange(camera.is_missing, false))
        remarks_.push_back({hc::Level::Info, camera.how.name + ": reconnected"});
    }
    const bool is_alone = std::none_of(cameras_.begin(), cameras_.end(), [&](const auto& other) {
      return other->side != camera.side && !other->is_missing;
    });
    if (is_alone) {
      auto& taken = taken_.emplace_back();
      (camera.side == 0 ? taken.left : taken.right) = std::move(**frame);
    } else {
      pairing_.add(camera.side, std::move(**frame));
      take_pairs();
    }
    while (taken_.size() > kMostTaken) taken_.pop_front();
    changed_.notify_all();
  }
}

/// Caller holds the mutex.
void LiveCameras::take_pairs() {
  bool any = false;
  for (; auto pair = pairing_.take(); any = true)
    taken_.push_back({std::move((*pair)[0]), std::move((*pair)[1])});
  const auto apart = pairing_.starves_by();
  const bool starves = apart || (is_starving_ && !any);
  if (std::exchange(is_starving_, starves) == starves) return;
  const std::string names = cameras_.front()->how.name + ", " + cameras_.back()->how.name;
  if (!apart) return remarks_.push_back({hc::Level::Info, names + ": pairs again"});
  remarks_.push_back(
      {hc::Level::Warning,
       names + ": no pairs for " + std::to_string(Pairing::kStarving.count()) +
           " s, so no images are sent: the times of their newest images are " +
           std::to_string(std::chrono::round<std::chrono::milliseconds>(*apart).count()) +
           " ms apart; compare the cameras' rates and clocks"});
}

hc::Result<std::optional<LiveCameras::Taken>> LiveCameras::next(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout,
                    [&] { return !taken_.empty() || failure_ || !remarks_.empty(); });
  if (failure_) return *failure_;
  const auto now = std::chrono::steady_clock::now();
  if (taken_.size() > 1 && now - kept_up_ > kBurst) taken_.erase(taken_.begin(), taken_.end() - 1);
  if (taken_.size() <= 1) kept_up_ = now;
  if (taken_.empty()) return std::optional<Taken>();
  std::optional<Taken> taken = std::move(taken_.front());
  taken_.pop_front();
  return taken;
}

void LiveCameras::adjust(const Adjustment& adjustment) {
  const std::lock_guard lock(mutex_);
  adjustment_ = adjustment;
}

std::vector<Remark> LiveCameras::remarks() {
  const std::lock_guard lock(mutex_);
  return std::exchange(remarks_, {});
}
