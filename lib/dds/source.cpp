// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include <dds/dds.h>
#include <dds/ddsc/dds_rhc.h>
#include <dds/ddsi/ddsi_tkmap.h>

#include <dds/ends.h>
#include <dds/participant.h>
#include <hc/link/link.h>
#include <hc/link/paced_source.h>
#include <hc/link/queue.h>
#include <hc/os/event.h>
#include <hc/os/reactor.h>

namespace hc::dds {
namespace {

using internal::Policy;
using internal::SendQueue;
using internal::TimePoint;
using std::chrono::steady_clock;

class DdsSource;

/// Receives samples from Cyclone DDS. Its own reader cache cannot be used: when that is full, the
/// receiving thread retries forever, and the reader cannot be deleted.
struct Cache : dds_rhc {
  explicit Cache(DdsSource& to);
  DdsSource& source;
};

/// A queued message and its size [byte].
struct Received {
  Message message;
  std::uint64_t bytes = 0;
};

class DdsSource final : public Source {
 public:
  /// With `keep=all`, writers are blocked when this much is queued. [byte]
  static constexpr std::uint64_t kWindow = std::uint64_t{2} << 20;
  static constexpr std::uint64_t kOverhead = 256;  // memory of a message besides its bytes [byte]
  /// How long data of a vanished writer may still arrive.
  static constexpr std::chrono::seconds kPatience{1};

  DdsSource(const Policy& policy, LinkOptions options, std::chrono::seconds wait,
            std::chrono::seconds reconnect)
      : blocks_writers_(policy.writer_waits()),
        options_(std::move(options)),
        reconnect_(reconnect),
        queue_(policy) {
    const auto patience = wait.count() > 0 ? wait : reconnect;
    if (patience.count() > 0) give_up_ = steady_clock::now() + patience;
  }

  ~DdsSource() override {
    {
      const std::lock_guard lock(mutex_);
      is_closing_ = true;
    }
    reader_.reset();  // no callbacks afterwards
    timer_.end();
  }

  Status begin(const Place& place) {
    event_ = HC_TRY(Event::make());
    if (auto started = timer_.start(-1, [this](auto) { event_.raise(); }); !started) return started;
    if (give_up_ != TimePoint::max()) timer_.call_at(give_up_);
    topic_ = place.topic;
    HC_TRY(entrance_.begin(place, event_));
    return enter();
  }

  Result<Got> take(Message& message) override {
    message = {};
    HC_TRY(enter());
    if (participant_ != nullptr) participant_->flush_log(options_.log);
    const std::lock_guard lock(mutex_);
    if (queue_.empty()) return nothing();
    auto [next, bytes] = queue_.pop({});  // the queue has no rate
    message = std::move(next);
    ++traffic_.messages;
    traffic_.bytes += bytes;
    return Got::Message;
  }

  /// Takes a sample on a thread of Cyclone DDS; false if there is no room.
  bool store(dds_instance_handle_t writer, ddsi_serdata& sample, ddsi_tkmap_instance& instance) {
    std::unique_lock lock(mutex_);
    // Keeps the topic's only instance, or Cyclone DDS would create it for each sample and wake a
    // thread to delete it.
    if (!std::exchange(has_instance_, true)) ddsi_tkmap_instance_ref(&instance);
    if (is_closing_ || sample.kind != SDK_DATA) return true;
    if (octets_of(sample) == 0) {
      if (closed_.insert(writer).second && alive() == 0) await_writer(std::chrono::seconds(0));
      return true;
    }
    if (blocks_writers_ && queue_.bytes() >= kWindow) return false;
    lock.unlock();
    const std::lock_guard reading(reading_);
    const auto read =
        read_messages(sample, options_.limits, memo_, [&](Message message, std::uint64_t bytes) {
          read_.push_back({std::move(message), bytes});
        });
    if (!read) drop(writer, read_.empty() ? "a sample" : "the rest of a sample", read.error());
    lock.lock();
    const bool is_first = queue_.empty();
    for (auto& [message, bytes] : read_)
      queue_.push({std::move(message), bytes}, bytes + kOverhead, losses_);
    lock.unlock();
    read_.clear();
    if (is_first) event_.raise();
    return true;
  }

  [[nodiscard]] int descriptor() const override { return event_.descriptor(); }

  [[nodiscard]] Traffic traffic() const override {
    const std::lock_guard lock(mutex_);
    Traffic all = losses_;
    all.messages = traffic_.messages;
    all.bytes = traffic_.bytes;
    return all;
  }

  void finish() override {
    const std::lock_guard lock(mutex_);
    is_final_ = true;
    event_.raise();
  }

 private:
  /// Reads the topic, once this host has the addresses.
  Status enter() {
    if (participant_ != nullptr) return {};
    event_.clear();
    participant_ = HC_TRY(entrance_.open(options_));
    if (participant_ == nullptr) return {};
    const auto qos = make_qos();
    const ListenerOwner listener(dds_create_listener(this));
    dds_lset_subscription_matched(
        listener.get(), [](dds_entity_t, const dds_subscription_matched_status_t status,
                           void* self) { static_cast<DdsSource*>(self)->count_writers(status); });
    const auto reader = dds_create_reader_rhc(participant_->handle(), participant_->topic(),
                                              qos.get(), listener.get(), &cache_);
    if (reader < 0) return failed("reader of " + topic_, reader);
    reader_ = Entity(reader);
    return {};
  }

  /// Called on a thread of Cyclone DDS.
  void count_writers(const dds_subscription_matched_status_t& status) {
    const std::lock_guard lock(mutex_);
    matched_ = status.current_count;
    const bool has_come = status.current_count_change > 0;
    const bool had_closed = !has_come && closed_.erase(status.last_publication_handle) > 0;
    if (has_come) {
      had_writer_ = true;
      give_up_ = TimePoint::max();
    } else if (!had_closed && alive() == 0) {
      await_writer(kPatience);
    }
  }

  /// The number of writers that have not closed. Call it with the mutex locked.
  [[nodiscard]] std::size_t alive() const { return matched_ - std::min(matched_, closed_.size()); }

  /// Waits for the next writer, at least for `least` since data may still arrive.
  void await_writer(std::chrono::seconds least) {
    give_up_ = steady_clock::now() + std::max(least, reconnect_);
    timer_.call_at(give_up_);
    event_.raise();
  }

  /// The result of take() with an empty queue. Call it with the mutex locked.
  Result<Got> nothing() {
    if (participant_ != nullptr) event_.clear();
    if (alive() > 0) return Got::Nothing;
    if (give_up_ > steady_clock::now() && !is_final_) return Got::Nothing;
    event_.raise();  // remains readable
    if (!had_writer_ && !is_final_)
      return participant_ != nullptr ? Error{Code::NotFound, "no writer on this topic"}
                                     : entrance_.missing();
    return Got::End;
  }

  /// Logs once per writer. Call it with `reading_` locked.
  void drop(dds_instance_handle_t writer, const std::string& what, const Error& why) {
    constexpr std::size_t kMost = 1000;
    if (warned_.size() >= kMost || !warned_.insert(writer).second) return;
    participant_->warn("dropped " + what + ": " + why.text() +
                       "; further ones of this writer are not logged");
  }

  const bool blocks_writers_;
  const LinkOptions options_;
  const std::chrono::seconds reconnect_;
  Event event_;

  std::mutex reading_;  // guards the members up to warned_; locked before mutex_
  internal::HeaderMemo memo_;
  std::vector<Received> read_;  // from the current sample
  std::set<dds_instance_handle_t> warned_;

  mutable std::mutex mutex_;  // guards the members up to give_up_
  Traffic traffic_;
  SendQueue<Received> queue_;
  Traffic losses_;
  std::size_t matched_ = 0;                 // writers
  std::set<dds_instance_handle_t> closed_;  // matched writers that have closed
  bool had_writer_ = false, is_final_ = false, is_closing_ = false;
  bool has_instance_ = false;             // holds the topic's instance until the domain ends
  TimePoint give_up_ = TimePoint::max();  // when to end; set while there is no writer

  Watch timer_;
  std::string topic_;
  Entrance entrance_;
  Cache cache_{*this};  // outlives the participant
  std::unique_ptr<Participant> participant_;
  Entity reader_;
};

dds_rhc_ops make_cache_ops() {
  dds_rhc_ops ops{};
  ops.rhc_ops.store = [](ddsi_rhc* cache, const ddsi_writer_info* writer, ddsi_serdata* sample,
                         ddsi_tkmap_instance* instance) {
    return reinterpret_cast<Cache*>(cache)->source.store(writer->iid, *sample, *instance);
  };
  ops.rhc_ops.unregister_wr = [](ddsi_rhc*, const ddsi_writer_info*) {};
  ops.rhc_ops.relinquish_ownership = [](ddsi_rhc*, std::uint64_t) {};
  ops.rhc_ops.set_qos = [](ddsi_rhc*, const dds_qos*) {};
  ops.rhc_ops.free = [](ddsi_rhc*) {};  // the source owns it
  // Samples are only taken by the source, through store().
  ops.read = ops.take = [](dds_rhc*, bool, void**, dds_sample_info_t*, std::uint32_t, std::uint32_t,
                           dds_instance_handle_t, dds_readcond*) { return std::int32_t{0}; };
  ops.readcdr = ops.takecdr = [](dds_rhc*, bool, ddsi_serdata**, dds_sample_info_t*, std::uint32_t,
                                 std::uint32_t, std::uint32_t, std::uint32_t,
                                 dds_instance_handle_t) { return std::int32_t{0}; };
  ops.add_readcondition = [](dds_rhc*, dds_readcond*) { return false; };
  ops.remove_readcondition = [](dds_rhc*, dds_readcond*) {};
  ops.lock_samples = [](dds_rhc*) { return std::uint32_t{0}; };
  ops.associate = [](dds_rhc*, dds_reader*, const ddsi_sertype*, ddsi_tkmap*) {
    return dds_return_t{DDS_RETCODE_OK};
  };
  return ops;
}

Cache::Cache(DdsSource& to) : dds_rhc{}, source(to) {
  static const dds_rhc_ops kOps = make_cache_ops();
  common.ops = &kOps;
}

}  // namespace

Result<std::unique_ptr<Source>> open_source(const Uri& uri, const LinkOptions& options) {
  auto place = HC_TRY(parse_place(uri));
  auto policy = HC_TRY(internal::parse_policy(uri));
  auto wait = HC_TRY(number_option(uri, "wait", 0));
  auto reconnect = HC_TRY(number_option(uri, "reconnect", 0));
  Policy unpaced = policy;
  unpaced.rate = unpaced.bandwidth = 0;
  auto source = std::make_unique<DdsSource>(unpaced, options, std::chrono::seconds(wait),
                                            std::chrono::seconds(reconnect));
  HC_TRY(source->begin(place));
  return internal::make_paced(std::move(source), policy);
}

}  // namespace hc::dds
