// SPDX-License-Identifier: Apache-2.0
#include <dds/ends.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <dds/participant.h>
#include <hc/link/audience.h>
#include <hc/link/link.h>
#include <hc/link/queue.h>
#include <hc/os/event.h>

namespace hc::dds {
namespace {

using internal::Audience;
using internal::Policy;
using internal::SendQueue;
using internal::TimePoint;
using std::chrono::steady_clock;

constexpr std::size_t kCapacity = 1000;  // queued messages before a sender with `keep=all` blocks
constexpr std::size_t kMostReaders = 1000;

/// Messages closer together than this count as a burst: no reply could arrive in between. From
/// kFewest messages on, a burst is batched.
constexpr std::chrono::microseconds kFollowTime{2};
constexpr std::size_t kFewest = 8;
/// Pause between batched samples; the kernel's timer slack adds about 60 µs.
constexpr std::chrono::microseconds kGather{20};

/// Writes directly if Cyclone DDS accepts the message. If it does not, because readers have not
/// acknowledged earlier ones, or if the rate delays it, the message is queued under the link's
/// policy and written by a thread. Bursts of small messages are also written by the thread: those
/// sent while it pauses are batched into the next sample.
class DdsSink final : public Sink {
 public:
  DdsSink(const Policy& policy, Audience audience, LinkOptions options)
      : waits_(policy.writer_waits()),
        is_paced_(policy.is_paced()),
        options_(std::move(options)),
        patience_(policy.timeout, options_.awaits_reader, options_.log),
        audience_(std::move(audience)),
        queue_(policy) {}

  ~DdsSink() override { end(); }

  Status begin(const Place& place) {
    event_ = HC_TRY(Event::make());
    topic_ = place.topic;
    HC_TRY(entrance_.begin(place, event_));
    return enter();
  }

  Status send(const Message& message) override {
    HC_TRY(enter());
    const auto pieces = encoder_.encode(message);
    const std::uint64_t size = pieces[0].size() + pieces[1].size() + pieces[2].size();
    if (size > UINT32_MAX - kFrame)
      return Error{Code::TooLarge, "a message of " + std::to_string(size) +
                                       " bytes exceeds the limit of a DDS sample"};
    std::unique_lock lock(mutex_);
    while (true) {
      if (failed_) return *failed_;
      if (has_ended_) return ended();
      const auto fate = audience_.decide(readers_);
      if (fate == Audience::Fate::End) return ended();
      if (fate == Audience::Fate::Kept) {
        HC_TRY(await_readers(lock));
        continue;
      }
      if (fate == Audience::Fate::Lost) {
        audience_.count_lost(traffic_);
        return {};
      }
      if (!waits_ || (queue_.messages() < kCapacity && queue_.has_memory(size))) break;
      const auto taken = traffic_.messages - traffic_.dropped_timeout - queue_.messages();
      if (patience_.is_over(taken) || !patience_.waits(taken, steady_clock::now())) {
        ++traffic_.messages;
        ++traffic_.dropped_timeout;
        return {};
      }
      if (auto waited = wait(lock, patience_.due()); !waited) {
        patience_.end();
        return waited;
      }
    }
    patience_.end();
    const bool follows = waits_ && size <= kMaxCopied && steady_clock::now() - sent_ < kFollowTime;
    following_ = follows ? following_ + 1 : 0;
    const bool is_direct = !is_paced_ && following_ < kFewest && queue_.empty();
    if (!is_direct || !write(*make_sample(participant_->type(), pieces, message))) {
      if (failed_) return *failed_;
      put_in_queue(pieces, message, size);
    }
    ++traffic_.messages;
    traffic_.bytes += size;
    sent_ = steady_clock::now();
    return {};
  }

  Status close() override {
    Status outcome;
    std::unique_lock lock(mutex_);
    if (audience_.is_awaited() && !has_ended_) outcome = await_readers(lock);
    while (outcome && !queue_.empty() && readers_ > 0 && !failed_ && !has_ended_)
      outcome = wait(lock);
    lock.unlock();
    // When a writer leaves, Cyclone DDS discards what its receiving thread holds while a reader has
    // no room. Once a later sample is acknowledged, it holds nothing, so the end is sent twice.
    if (outcome) outcome = await_acknowledgements();
    for (int i = 0; i < 2 && outcome; ++i) outcome = send_end();
    if (participant_ != nullptr) participant_->flush_log(options_.log);
    end();
    return outcome;
  }

  void abandon() override {
    const std::lock_guard lock(mutex_);
    give_up();
  }

  [[nodiscard]] bool is_behind() const override {
    const std::lock_guard lock(mutex_);
    return !queue_.empty();
  }

  [[nodiscard]] Traffic traffic() const override {
    const std::lock_guard lock(mutex_);
    return traffic_;
  }

 private:
  /// Writes the topic, once this host has the addresses.
  Status enter() {
    if (participant_ != nullptr) {
      participant_->flush_log(options_.log);
      return {};
    }
    participant_ = HC_TRY(entrance_.open(options_));
    if (participant_ == nullptr) return {};
    const auto qos = make_qos();
    const ListenerOwner listener(dds_create_listener(this));
    dds_lset_publication_matched(
        listener.get(),
        [](dds_entity_t, const dds_publication_matched_status_t status, void* self) {
          static_cast<DdsSink*>(self)->count_readers(status.current_count);
        });
    const auto writer =
        dds_create_writer(participant_->handle(), participant_->topic(), qos.get(), listener.get());
    if (writer < 0) return failed("writer of " + topic_, writer);
    writer_ = Entity(writer);
    return keep_instance(writer, topic_);
  }

  /// A topic without a key has one instance. Keeps it, or Cyclone DDS would create it for each
  /// sample and wake a thread to delete it.
  static Status keep_instance(dds_entity_t writer, const std::string& topic) {
    dds_instance_handle_t handle = 0;
    const auto kept = dds_register_instance(writer, &handle, &handle);  // the data is ignored
    return kept == DDS_RETCODE_OK ? Status() : failed("writer of " + topic, kept);
  }

  /// Called on a thread of Cyclone DDS.
  void count_readers(std::uint32_t count) {
    const std::lock_guard lock(mutex_);
    readers_ = count;
    if (count == 0 && audience_.ends_with_readers()) return give_up();
    event_.raise();
    changed_.notify_one();
  }

  /// Stops sending. Call it with the mutex locked.
  void give_up() {
    has_ended_ = true;
    traffic_.dropped_disconnect += queue_.clear(traffic_);
    event_.raise();
    changed_.notify_one();
  }
  [[nodiscard]] Error ended() const {
    const bool have_left = audience_.ends_with_readers() && readers_ == 0;
    return {Code::Closed, have_left ? "all readers disconnected" : "the link is closed"};
  }

  /// Waits for a change, at most until `until`; unlocks the mutex meanwhile.
  Status wait(std::unique_lock<std::mutex>& lock, TimePoint until = TimePoint::max()) {
    if (event_.clear()) return {};
    lock.unlock();
    auto waited = internal::wait_for_event(event_.descriptor(), options_, until);
    lock.lock();
    return waited;
  }

  Status await_readers(std::unique_lock<std::mutex>& lock) {
    lock.unlock();
    auto awaited = audience_.await(event_.descriptor(), options_, [this]() -> Result<std::size_t> {
      event_.clear();
      HC_TRY(enter());
      const std::lock_guard locked(mutex_);
      if (has_ended_) return ended();
      return readers_;
    });
    lock.lock();
    return awaited;
  }

  /// Queues a message; appends it to the last sample if it is small and the link neither drops nor
  /// delays messages. Call it with the mutex locked.
  void put_in_queue(const Pieces& pieces, const Message& message, std::uint64_t size) {
    const bool may_join = waits_ && !is_paced_ && !queue_.empty();
    if (may_join && join(*queue_.back(), pieces))
      queue_.grow_last(size);
    else
      queue_.push(make_sample(participant_->type(), pieces, message), size, traffic_);
    if (!thread_.joinable()) thread_ = std::thread([this] { write_all(); });
    changed_.notify_one();
  }

  /// Writes a sample; false if Cyclone DDS has no room or fails. Call it with the mutex locked.
  bool write(ddsi_serdata& sample) {
    const auto written = dds_writecdr(writer_.handle(), ddsi_serdata_ref(&sample));
    if (written != DDS_RETCODE_OK && written != DDS_RETCODE_TIMEOUT) {
      failed_ = failed("write", written);
      event_.raise();  // wakes a blocked sender
    }
    return written == DDS_RETCODE_OK;
  }

  /// Writes the queue, on the thread.
  void write_all() {
    constexpr std::chrono::microseconds kShortest{100}, kLongest{10'000};
    auto pause = kShortest;
    std::unique_lock lock(mutex_);
    while (!has_ended_ && !failed_) {
      const auto now = steady_clock::now();
      const auto ready = queue_.ready_at(now, traffic_);
      if (ready == TimePoint::max() || (readers_ == 0 && waits_)) {
        changed_.wait(lock);
      } else if (ready > now) {
        changed_.wait_until(lock, ready);
      } else if (readers_ > 0 && !write(*queue_.front())) {
        lock.unlock();
        dds_wait_for_acks(writer_.handle(), pause.count() * 1000);
        pause = std::min(2 * pause, kLongest);
        lock.lock();
      } else {
        if (readers_ == 0) ++traffic_.dropped_disconnect;
        queue_.pop(now);
        pause = kShortest;
        event_.raise();
        if (!waits_ || !queue_.empty()) continue;
        lock.unlock();
        std::this_thread::sleep_for(kGather);
        lock.lock();
      }
    }
  }

  Status send_end() {
    if (participant_ == nullptr) return {};
    const auto end = make_end(participant_->type());
    {
      const std::lock_guard lock(mutex_);
      if (readers_ == 0 || has_ended_ || failed_) return {};
      write(*end);
    }
    return await_acknowledgements();
  }

  /// Waits until all readers have acknowledged everything or have left.
  Status await_acknowledgements() {
    constexpr std::chrono::seconds kGrace{2};  // after a request to stop
    std::optional<TimePoint> give_up;
    while (true) {
      {
        const std::lock_guard lock(mutex_);
        if (readers_ == 0 || has_ended_ || failed_) return failed_ ? Status(*failed_) : Status();
      }
      if (dds_wait_for_acks(writer_.handle(), DDS_MSECS(20)) != DDS_RETCODE_TIMEOUT) return {};
      const auto now = steady_clock::now();
      if (!give_up && !wait_for(-1, 0, options_.stop, now)) give_up = now + kGrace;
      if (give_up && now >= *give_up)
        return Error{Code::Truncated, "a reader has not acknowledged all messages"};
    }
  }

  void end() {
    abandon();
    if (thread_.joinable()) thread_.join();
    writer_.reset();
  }

  const bool waits_, is_paced_;
  LinkOptions options_;
  internal::Patience patience_;
  Encoder encoder_;
  Event event_;  // raised when the state below changes

  mutable std::mutex mutex_;  // guards the members up to failed_
  Audience audience_;
  std::condition_variable changed_;
  SendQueue<Sample> queue_;
  TimePoint sent_{};           // of the last message
  std::size_t following_ = 0;  // length of the current burst
  Traffic traffic_;
  std::uint32_t readers_ = 0;
  bool has_ended_ = false;
  std::optional<Error> failed_;

  std::thread thread_;
  std::string topic_;
  Entrance entrance_;
  std::unique_ptr<Participant> participant_;
  Entity writer_;
};

}  // namespace

Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options) {
  auto place = HC_TRY(parse_place(uri));
  auto policy = HC_TRY(internal::parse_policy(uri));
  auto audience = HC_TRY(Audience::make(uri, kMostReaders, policy, options));
  auto sink = std::make_unique<DdsSink>(policy, audience, options);
  HC_TRY(sink->begin(place));
  return std::unique_ptr<Sink>(std::move(sink));
}

}  // namespace hc::dds
