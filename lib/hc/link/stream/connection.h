// SPDX-License-Identifier: Apache-2.0
#pragma once
// The sending side of one connection. Messages are written by the thread that sends them or, where
// that thread must not wait, by the reactor. Internal.

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

/// Decides whether to collect messages and write them together: 20 to 35 times as many of 96 B go
/// over a socket (bench/links). But a single message would only be delayed; so each batch that
/// stays small doubles the number that must follow one another before the next batch is started.
class Gathering {
 public:
  /// Counts a message, which follows the one before closely or not. Returns whether to collect it.
  bool pays(bool follows) {
    row_ = follows ? row_ + 1 : 0;
    return row_ > wanted_;
  }
  /// Reports how many messages were written together.
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
/// A message is written at once if the queue is empty. Small messages in close succession are
/// collected, up to kFlushBytes or for kFlushAge; see Gathering. The policy applies to the queue
/// only: messages that were collected or partly written are never dropped. A sending thread that
/// waits releases the lock, and does all the work in place of the reactor.
class Connection final : public Sink {
 public:
  /// After `stop`, how long to wait for a reader to take the rest of a message.
  static constexpr std::chrono::seconds kGrace{2};
  /// How often to check that a reader which has not acknowledged everything is still alive.
  static constexpr std::chrono::seconds kLookPeriod{1};
  /// Two messages are in close succession if the last system call is no longer ago than this.
  static constexpr std::chrono::microseconds kFollowTime{3};
  static constexpr std::chrono::microseconds kFlushAge{150};
  static constexpr std::size_t kFlushBytes = 60 << 10;

  /// @param connection  may be none (-1) with a dialer.
  /// @param dialer  reconnects when the connection is lost; without it the link ends.
  ///
  /// Errors: System.
  static Result<std::unique_ptr<Connection>> make(ConnectedSocket connection, const Policy& policy,
                                                  const LinkOptions& options,
                                                  std::unique_ptr<Dialer> dialer = nullptr);
  ~Connection() override { abandon(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Status send(const Message& message) override;
  Status close() override;
  /// Writes as much as the descriptor takes without waiting, and drops the rest.
  void abandon() override;
  [[nodiscard]] Traffic traffic() const override;
  std::optional<std::size_t> peers() override;
  [[nodiscard]] bool is_behind() const override;

  // For sinks with several connections, which count messages themselves.
  /// Sends a message. Returns whether everything sent so far has been written to the descriptor.
  /// Errors: as Sink::send.
  Result<bool> send(Outgoing& message, TimePoint now);
  /// Waits until everything is written, if `patient`, and ends the stream.
  /// Errors: as Sink::close.
  Status close(bool patient);
  /// Counts of lost and throttled messages; `bytes` is the negated size of the dropped ones.
  [[nodiscard]] Traffic losses() const;
  /// Whether the connection has failed for good.
  [[nodiscard]] bool has_failed() const;
  [[nodiscard]] int descriptor() const { return writer_.descriptor(); }

 private:
  Connection(const Policy& policy, const LinkOptions& options, std::unique_ptr<Dialer> dialer)
      : writer_waits_(policy.writer_waits()),
        bandwidth_(policy.bandwidth),
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
  const std::uint64_t bandwidth_;
  const int stop_;
  const LogSink log_;
  std::unique_ptr<Dialer> dialer_;
  SendQueue<Parcel> queue_;
  Patience patience_;
  StreamWriter writer_;   // collected or partly written messages, ahead of the queue
  bool blocked_ = false;  // the last write could not write everything
  bool is_tcp_ = false;
  Gathering gathering_;
  TimePoint connected_at_, last_write_;
  TimePoint oldest_;  // when the first message of the batch was collected
  TimePoint look_due_ = TimePoint::max();
  bool is_gathering_ = false;
  bool flush_is_due_ = false;  // the reactor will write the batch
  std::optional<Error> failed_;
  Traffic losses_;
  Encoder encoder_;
  std::uint64_t messages_ = 0, bytes_ = 0;  // sent
  Remarks remarks_;                         // logged by the sending thread
  std::uint32_t wanted_ = 0;                // of watch_
  bool waits_ = false;                      // a thread is in wait()
  bool is_sending_ = false;                 // a thread is in send()
  Watch watch_;  // of the connection or the dialer's attempt, and the timer
};

}  // namespace hc::internal
