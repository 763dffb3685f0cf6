// SPDX-License-Identifier: Apache-2.0
#include <dds/ends.h>

#include <array>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include <dds/participant.h>
#include <hc/base/backoff.h>
#include <hc/link/link.h>
#include <hc/link/queue.h>
#include <hc/os/event.h>
#include <hc/os/wait_readable.h>

namespace hc::dds {
namespace {

using internal::Policy;
using internal::SendQueue;
using internal::TimePoint;
using std::chrono::steady_clock;

constexpr std::size_t kCapacity = 1000;  // messages that wait before a sender that loses none does

/// Messages follow one another when no more time has passed between them: sooner than any could be
/// answered, or another be computed. From so many on they are gathered.
constexpr std::chrono::microseconds kFollowTime{2};
constexpr std::size_t kFewest = 8;
/// Between two samples of what is gathered; some 60 µs more by the kernel's timer slack.
constexpr std::chrono::microseconds kGather{20};

/// Writes at once where Cyclone DDS takes a message. Where it does not, since readers have not
/// acknowledged what went before, or the pace says so, the message waits by the link's policy, and
/// a thread writes it as soon as may be. So it is with small messages that follow one another: what
/// comes while the thread writes goes together in the next sample.
class DdsSink final : public Sink {
 public:
  DdsSink(const Policy& policy, LinkOptions options, std::int64_t readers, bool stays)
      : waits_(policy.writer_waits()),
        is_paced_(policy.is_paced()),
        wanted_(readers),
        stays_(stays),
        options_(std::move(options)),
        patience_(policy.timeout, options_.awaits_reader),
        absence_(policy.timeout),
        queue_(policy) {}

  ~DdsSink() override { end(); }

  Status begin(const Place& place) {
    auto event = internal::Event::make();
    if (!event) return event.error();
    event_ = std::move(*event);
    auto participant = Participant::open(place, options_.limits);
    if (!participant) return participant.error();
    participant_ = std::move(*participant);
    const auto qos = make_qos();
    const ListenerOwner listener(dds_create_listener(this));
    dds_lset_publication_matched(
        listener.get(),
        [](dds_entity_t, const dds_publication_matched_status_t status, void* self) {
          static_cast<DdsSink*>(self)->count_readers(status.current_count);
        });
    const auto writer =
        dds_create_writer(participant_->handle(), participant_->topic(), qos.get(), listener.get());
    if (writer < 0) return failed("writer of " + place.topic, writer);
    writer_ = Entity(writer);
    return keep_instance(writer, place.topic);
  }

  Status send(const Message& message) override {
    participant_->flush_log(options_.log);
    const auto pieces = encoder_.encode(message);
    const std::uint64_t size = pieces[0].size() + pieces[1].size() + pieces[2].size();
    if (size > UINT32_MAX - kFrame)
      return Error{Code::TooLarge, "a message of " + std::to_string(size) +
                                       " bytes is larger than any sample of DDS"};
    std::unique_lock lock(mutex_);
    while (true) {
      if (failed_) return *failed_;
      if (has_ended_)
        return Error{Code::Closed,
                     has_lost_all_ ? "all readers disconnected" : "the link is closed"};
      if (readers_ != 0) absence_.renew();
      const bool goes_on = absence_.is_over() || (stays_ && !waits_);
      const bool needs_none = wanted_ == 0 || (has_begun_ && goes_on);
      if (readers_ == 0 && needs_none) {
        has_begun_ = true;
        ++messages_;
        ++(absence_.is_over() ? losses_.timed_out : losses_.cut);
        return {};
      }
      if (readers_ < needed()) {
        if (auto awaited = await_readers(lock); !awaited) return awaited;
        continue;
      }
      has_begun_ = true;
      if (!waits_ || (queue_.size() < kCapacity && queue_.has_memory(size))) break;
      if (!has_patience()) {
        ++messages_;
        ++losses_.timed_out;
        return {};
      }
      if (auto waited = wait(lock, patience_.due()); !waited) {
        patience_.end();
        return waited;
      }
    }
    patience_.end();
    auto sample = make_sample(participant_->type(), pieces, message);
    const bool follows = waits_ && size <= kMostCopied && steady_clock::now() - sent_ < kFollowTime;
    following_ = follows ? following_ + 1 : 0;
    if (is_paced_ || following_ >= kFewest || !queue_.empty() || joined_ || !write(*sample)) {
      if (failed_) return *failed_;
      queue_.push(std::move(sample), size, losses_);
      if (!thread_.joinable()) thread_ = std::thread([this] { write_all(); });
      changed_.notify_one();
    }
    ++messages_;
    bytes_ += size;
    sent_ = steady_clock::now();
    return {};
  }

  Status close() override {
    Status outcome;
    std::unique_lock lock(mutex_);
    if (wanted_ > 0 && !has_begun_ && !has_ended_) outcome = await_readers(lock);
    while (outcome && (!queue_.empty() || joined_) && readers_ > 0 && !failed_ && !has_ended_)
      outcome = wait(lock);
    lock.unlock();
    // Cyclone DDS throws away what its receiving thread holds while a reader has no room, when the
    // writer leaves; what comes after that has been answered for says that it holds nothing. So the
    // end is said twice.
    if (outcome) outcome = await_answers();
    for (int i = 0; i < 2 && outcome; ++i) outcome = say_end();
    participant_->flush_log(options_.log);
    end();
    return outcome;
  }

  void abandon() override {
    const std::lock_guard lock(mutex_);
    give_up();
  }

  [[nodiscard]] Traffic traffic() const override {
    const std::lock_guard lock(mutex_);
    Traffic all = losses_;
    all.messages = messages_;
    all.bytes += bytes_;
    return all;
  }

 private:
  /// A topic without a key has one instance. Cyclone DDS would make it for each sample again, and
  /// wake a thread to delete it.
  static Status keep_instance(dds_entity_t writer, const std::string& topic) {
    dds_instance_handle_t handle = 0;
    const auto kept = dds_register_instance(writer, &handle, &handle);  // whatever the data
    return kept == DDS_RETCODE_OK ? Status() : failed("writer of " + topic, kept);
  }

  /// How many readers the next message wants.
  [[nodiscard]] std::uint32_t needed() const {
    if (has_begun_ || wanted_ < 0) return 1;
    return static_cast<std::uint32_t>(wanted_);
  }

  /// Called on a thread of Cyclone's.
  void count_readers(std::uint32_t count) {
    const std::lock_guard lock(mutex_);
    readers_ = count;
    if (count == 0 && has_begun_ && wanted_ > 0 && !stays_) {
      has_lost_all_ = true;
      return give_up();
    }
    event_.raise();
    changed_.notify_one();
  }

  /// Sends no more. With the mutex.
  void give_up() {
    has_ended_ = true;
    losses_.cut += queue_.clear(losses_);
    if (!is_handing_over_) lose_joined();
    event_.raise();
    changed_.notify_one();
  }
  void lose_joined() {
    losses_.cut += std::exchange(joined_messages_, 0);
    losses_.bytes -= std::exchange(joined_bytes_, 0);
  }

  /// Whether the readers, of which there is one reckoning, are to be waited for. With the mutex.
  bool has_patience() {
    const auto taken = messages_ - losses_.timed_out - queue_.size() - joined_messages_;
    const bool was_over = patience_.is_over();
    if (patience_.is_over(taken)) return false;
    if (was_over) log(internal::Patience::kAgain);
    if (patience_.waits(taken, steady_clock::now())) return true;
    log(patience_.line());
    return false;
  }
  void log(std::string_view line) const {
    if (options_.log) options_.log(Severity::Warning, line);
  }

  /// Waits until something has changed, or for so long; the lock is free meanwhile.
  Status wait(std::unique_lock<std::mutex>& lock, TimePoint until = TimePoint::max()) {
    if (event_.clear()) return {};
    lock.unlock();
    auto& [interrupter, call] = options_.interrupt;
    auto timeout = std::chrono::milliseconds(-1);
    if (until != TimePoint::max())
      timeout = std::max(std::chrono::milliseconds(0),
                         std::chrono::ceil<std::chrono::milliseconds>(until - steady_clock::now()));
    auto ready =
        wait_readable(std::array{event_.descriptor(), interrupter}, options_.stop, timeout);
    if (ready && *ready == 1 && !call()) interrupter = -1;
    lock.lock();
    return ready ? Status() : ready.error();
  }

  Status await_readers(std::unique_lock<std::mutex>& lock) {
    const auto say = [&](bool awaits) {
      if (!options_.awaits_reader) return;
      lock.unlock();
      options_.awaits_reader(awaits);
      lock.lock();
    };
    say(true);
    Status outcome;
    while (outcome && readers_ < needed() && !has_ended_) {
      if (has_begun_ && !absence_.waits(0, steady_clock::now())) {
        log(absence_.line());
        break;
      }
      outcome = wait(lock, absence_.due());
    }
    absence_.end();
    say(false);
    return outcome;
  }

  /// Hands a sample to Cyclone DDS; false where there is no room, or it has failed. With the mutex.
  bool write(ddsi_serdata& sample) { return is_written(hand_over(sample)); }

  dds_return_t hand_over(ddsi_serdata& sample) const {
    return dds_writecdr(writer_.handle(), ddsi_serdata_ref(&sample));
  }

  bool is_written(dds_return_t written) {
    if (written != DDS_RETCODE_OK && written != DDS_RETCODE_TIMEOUT) {
      failed_ = failed("written", written);
      event_.raise();  // for a sender that waits
    }
    return written == DDS_RETCODE_OK;
  }

  /// Takes what is ready at the front of the queue as one sample, of which nothing is lost.
  void join_first(TimePoint now) {
    const auto take = [&] {
      const auto before = queue_.bytes();
      auto sample = queue_.pop(now);
      ++joined_messages_;
      joined_bytes_ += before - queue_.bytes();
      return sample;
    };
    joined_ = take();
    while (queue_.ready_at(now, losses_) <= now && join(*joined_, *queue_.front())) take();
  }

  /// Writes the first that waits; false where there is no room for it. The lock is free meanwhile
  /// where nothing may be dropped.
  bool write_first(std::unique_lock<std::mutex>& lock, TimePoint now) {
    if (!waits_) {
      if (!write(*queue_.front())) return false;
      queue_.pop(now);
      return true;
    }
    if (!joined_) join_first(now);
    is_handing_over_ = true;
    lock.unlock();
    const auto written = hand_over(*joined_);
    lock.lock();
    is_handing_over_ = false;
    if (!is_written(written)) {
      if (has_ended_) lose_joined();
      return false;
    }
    joined_.reset();
    joined_messages_ = joined_bytes_ = 0;
    return true;
  }

  /// What the thread does: writes what waits.
  void write_all() {
    constexpr std::chrono::microseconds kShortest{100}, kLongest{10'000};
    auto pause = kShortest;
    bool gathers = false;
    std::unique_lock lock(mutex_);
    while (!has_ended_ && !failed_) {
      const auto now = steady_clock::now();
      if (queue_.empty() && std::exchange(gathers, false)) {
        lock.unlock();
        std::this_thread::sleep_for(kGather);
        lock.lock();
        continue;
      }
      if (const auto ready = queue_.ready_at(now, losses_); !joined_ && ready > now) {
        if (ready == TimePoint::max())
          changed_.wait(lock);
        else
          changed_.wait_until(lock, ready);
        continue;
      }
      if (readers_ == 0 && waits_) {
        changed_.wait(lock);
        continue;
      }
      if (readers_ == 0) {
        losses_.cut += 1;
        queue_.pop(now);
      } else if (write_first(lock, now)) {
        gathers = waits_;
        pause = kShortest;
      } else {
        lock.unlock();
        dds_wait_for_acks(writer_.handle(), pause.count() * 1000);
        pause = std::min(2 * pause, kLongest);
        lock.lock();
        continue;
      }
      event_.raise();
    }
  }

  Status say_end() {
    const auto end = make_end(participant_->type());
    {
      const std::lock_guard lock(mutex_);
      if (readers_ == 0 || has_ended_ || failed_) return {};
      write(*end);
    }
    return await_answers();
  }

  /// Waits until all readers have what was written, or have left.
  Status await_answers() {
    constexpr std::chrono::seconds kGrace{2};  // after it is to stop
    std::optional<TimePoint> give_up;
    while (true) {
      {
        const std::lock_guard lock(mutex_);
        if (readers_ == 0 || has_ended_ || failed_) return failed_ ? Status(*failed_) : Status();
      }
      if (dds_wait_for_acks(writer_.handle(), DDS_MSECS(20)) != DDS_RETCODE_TIMEOUT) return {};
      const auto now = steady_clock::now();
      if (!give_up && !internal::wait_for(-1, 0, options_.stop, now)) give_up = now + kGrace;
      if (give_up && now >= *give_up)
        return Error{Code::Truncated, "a reader has not acknowledged what was sent to it"};
    }
  }

  /// Ends the thread, and the link.
  void end() {
    abandon();
    if (thread_.joinable()) thread_.join();
    writer_.reset();
  }

  const bool waits_, is_paced_;
  const std::int64_t wanted_;  // readers before the first message and the end; -1: one, none
  const bool stays_;
  LinkOptions options_;
  internal::Patience patience_, absence_;  // with readers; with all that have left
  Encoder encoder_;
  internal::Event event_;  // readable when something has changed that is waited for

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  SendQueue<Sample> queue_;
  Sample joined_;  // taken out of the queue to be written, of so many messages and bytes
  std::uint64_t joined_messages_ = 0, joined_bytes_ = 0;
  bool is_handing_over_ = false;  // joined_; whether it is lost is not known yet
  TimePoint sent_{};              // when the last message was
  std::size_t following_ = 0;     // messages that have followed one another so far
  Traffic losses_;
  std::uint64_t messages_ = 0, bytes_ = 0;
  std::uint32_t readers_ = 0;
  bool has_begun_ = false;  // the readers that were to be waited for have come
  bool has_ended_ = false, has_lost_all_ = false;
  std::optional<Error> failed_;

  std::thread thread_;
  std::unique_ptr<Participant> participant_;
  Entity writer_;
};

}  // namespace

Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options) {
  auto place = parse_place(uri);
  if (!place) return place.error();
  constexpr std::int64_t kMostReaders = 1000;
  auto readers = number_option(uri, "readers", -1, {0, kMostReaders});
  if (!readers) return readers.error();
  auto stays = number_option(uri, "stay", 0, {0, 1});
  if (!stays) return stays.error();
  auto policy = internal::parse_policy(uri);
  if (!policy) return policy.error();
  auto sink = std::make_unique<DdsSink>(*policy, options, *readers, *stays == 1);
  if (auto begun = sink->begin(*place); !begun) return begun.error();
  return std::unique_ptr<Sink>(std::move(sink));
}

}  // namespace hc::dds
