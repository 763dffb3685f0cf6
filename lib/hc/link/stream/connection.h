// SPDX-License-Identifier: Apache-2.0
#pragma once
// The sending side of one connection: what is to go over it waits, is begun, and goes, by the
// thread that sends or, where that one is not to wait, by the reactor. Internal.

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <hc/link/link.h>
#include <hc/link/policy.h>
#include <hc/link/queue.h>
#include <hc/link/stream/dialer.h>
#include <hc/link/stream/remarks.h>
#include <hc/link/stream/writer.h>
#include <hc/os/reactor.h>

namespace hc::internal {

/// Learns whether messages follow so close that it pays to gather them: written one by one, 20 to
/// 35 times fewer messages of 96 B a second go over a socket (bench/links). Who answers a question
/// sends nothing more, though; so the more often it was in vain to wait for another message, the
/// longer a row of them must be before the next one is gathered.
class Gathering {
 public:
  /// Counts a message that follows, or not; gives whether to gather it.
  bool pays(bool follows) {
    row_ = follows ? row_ + 1 : 0;
    return row_ > wanted_;
  }
  /// Says how many messages were written at once in the end.
  void learn(std::size_t count) {
    bool was_worth_it = count >= kWorthwhile;
    if (!was_worth_it) row_ = 0;
    wanted_ = was_worth_it ? kFewest : std::min(2 * wanted_, kMost);
  }

 private:
  static constexpr std::size_t kWorthwhile = 8, kFewest = 2, kMost = 1024;
  std::size_t row_ = 0, wanted_ = kFewest;
};

/// Sends the messages of one thread over one connection, with the help of the reactor.
///
/// A message is written at once where nothing waits. When some follow right behind another,
/// small ones are gathered, up to kFlushBytes or kFlushAge, whichever comes first; see Gathering.
/// What is gathered or partly written has been begun and is finished; the policy is about what
/// waits behind it.
///
/// The lock is free while a sending thread waits; that thread then sees to all there is to do, and
/// the reactor to nothing.
class Connection final : public Sink {
 public:
  /// How long a reader may take, after `stop`, for the rest of a message.
  static constexpr std::chrono::seconds kGrace{2};
  /// How often a reader that owes an answer is looked after, whether it is still there.
  static constexpr std::chrono::seconds kLookPeriod{1};
  /// Messages follow one another when no more time has passed since the last system call.
  static constexpr std::chrono::microseconds kFollowTime{3};
  static constexpr std::chrono::microseconds kFlushAge{150};
  static constexpr std::size_t kFlushBytes = 60 << 10;

  /// @param connection  may be none (-1) with a dialer.
  /// @param dialer  reconnects when the connection is lost; without one the link ends with it.
  ///
  /// Errors: System.
  static Result<std::unique_ptr<Connection>> make(ConnectedSocket connection, const Policy& policy,
                                                  const LinkOptions& options,
                                                  std::unique_ptr<Dialer> dialer = nullptr);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Status send(const Message& message) override;
  Status close() override;
  /// Ends the link with what can be written at once; the rest is lost.
  void abandon() override;
  [[nodiscard]] Traffic traffic() const override;
  std::optional<std::size_t> peers() override;

  // Of a message that goes to several, for who counts them.
  /// Takes a message; whether all that was taken is with the kernel, and not in memory of ours.
  /// Errors: as Sink::send.
  Result<bool> send(Outgoing& message, TimePoint now);
  /// Waits until all has been written, unless it is not `patient`, and ends the stream.
  /// Errors: as Sink::close.
  Status close(bool patient);
  /// What was lost or throttled; `bytes` is minus those of messages that were dropped.
  [[nodiscard]] Traffic losses() const;
  /// Whether the connection has failed for good.
  [[nodiscard]] bool has_failed() const;
  [[nodiscard]] int descriptor() const { return writer_.descriptor(); }

 private:
  Connection(const Policy& policy, const LinkOptions& options, std::unique_ptr<Dialer> dialer)
      : writer_waits_(policy.writer_waits()),
        stop_(options.stop),
        log_(options.log),
        dialer_(std::move(dialer)),
        queue_(policy),
        patience_(policy.timeout, options.awaits_reader, options.log) {
    if (dialer_ != nullptr)
      dialer_->log_to(
          [this](Level level, std::string_view line) { remarks_.add(std::string(line), level); });
  }

  [[nodiscard]] bool connected() const { return writer_.descriptor() >= 0; }
  [[nodiscard]] bool all_written() const { return writer_.empty() && queue_.empty(); }
  Result<bool> hand_over(std::unique_lock<std::mutex>& lock, Outgoing& message, TimePoint now);
  void connect(ConnectedSocket connection, TimePoint now);
  void dial(TimePoint now);
  void put(const Parcel& parcel, TimePoint now);
  void advance(TimePoint now);
  void write();
  void lose_connection(const Error& why, TimePoint now);
  void fail(const Error& why);
  void look_at_reader(TimePoint now);
  void check_connection(TimePoint now);
  void on_event(std::uint32_t events);
  void arm(TimePoint now);
  [[nodiscard]] short awaited_events() const;
  void want(std::uint32_t events);
  void stop_watching();
  [[nodiscard]] TimePoint due(TimePoint now);
  [[nodiscard]] TimePoint flush_due() const { return oldest_ + 2 * kFlushAge; }
  bool take_back();
  bool drops_for_reader(const Outgoing& message, TimePoint now);
  bool has_patience(TimePoint now);
  void give_up_reader(Outgoing& message);
  Status drain(std::unique_lock<std::mutex>& lock, Outgoing* message,
               std::optional<TimePoint> give_up = std::nullopt);
  Result<bool> wait(std::unique_lock<std::mutex>& lock, std::optional<TimePoint> give_up,
                    TimePoint now);

  mutable std::mutex mutex_;
  const bool writer_waits_;
  const int stop_;
  const LogSink log_;
  std::unique_ptr<Dialer> dialer_;
  SendQueue<Parcel> queue_;  // not begun
  Patience patience_;
  StreamWriter writer_;   // begun
  bool blocked_ = false;  // the last write found no room for all
  bool is_tcp_ = false;
  Gathering gathering_;
  TimePoint connected_at_, last_write_, oldest_;  // the last: when the first was gathered
  TimePoint look_due_ = TimePoint::max();
  bool is_gathering_ = false;
  bool flush_is_due_ = false;  // the reactor will look at what is gathered
  std::optional<Error> failed_;
  Traffic losses_;
  Encoder encoder_;
  std::uint64_t messages_ = 0, bytes_ = 0;  // that send() has taken
  Remarks remarks_;                         // for the log of the thread that sends
  std::uint32_t wanted_ = 0;                // of watch_
  bool waits_ = false;                      // a thread, in wait()
  bool is_sending_ = false;                 // a thread, in send()
  Watch watch_;  // of the connection or the dialer's attempt, and of the next time
};

}  // namespace hc::internal
