// SPDX-License-Identifier: Apache-2.0
// Files of messages as recordings, with log times derived from the messages' times.
#include <algorithm>
#include <filesystem>
#include <utility>

#include <record/reader.h>

namespace hc::record {
namespace {

/// Derives monotonic log times from the times of messages.
class LogTimes {
 public:
  Time last;

  void add(Time time) {
    constexpr std::chrono::seconds kDisorder{1};  // tolerated between modules
    if (time <= Time()) return;
    const bool is_back = time < last - kDisorder;
    if (is_back) time = later(time, shift_);
    if (is_back && time < last - kDisorder) {  // the clock was set back again
      shift_ += last - time;
      time = last;
    }
    last = std::max(last, time);
  }

 private:
  std::chrono::nanoseconds shift_{0};
};

class MessageReader final : public Reader {
 public:
  MessageReader(const Place& place, const LinkOptions& options, std::unique_ptr<Source> source)
      : place_(place), options_(options), source_(std::move(source)), name_(place.name()) {}

  Result<Got> take(Message& message) override {
    message = {};
    auto got = read_ahead();
    if (got && *got == Got::Message) message = std::move(*std::exchange(ahead_, std::nullopt));
    return got;
  }
  Result<std::optional<Time>> next_time() override {
    auto got = read_ahead();
    if (!got) return got.error();
    return *got == Got::Message ? std::optional(times_.last) : std::nullopt;
  }

  [[nodiscard]] Time log_time() const override { return times_.last; }
  [[nodiscard]] std::string_view stream() const override { return name_; }
  [[nodiscard]] bool mixes_sources() const override { return place_.stream.empty(); }
  [[nodiscard]] int descriptor() const override { return source_->descriptor(); }
  [[nodiscard]] int wake_descriptor() const override { return source_->wake_descriptor(); }
  bool prepare_wait() override { return !ahead_ && source_->prepare_wait(); }
  [[nodiscard]] Traffic traffic() const override { return source_->traffic(); }
  Status resume() override { return source_->resume(); }
  void start_at(Time log_time) override {
    start_ = log_time;
    if (times_.last < start_) ahead_.reset();
  }

  Result<std::vector<StreamInfo>> streams(StreamDetail detail) override {
    StreamInfo info;
    info.name = name_;
    if (detail == StreamDetail::Names) return std::vector{std::move(info)};
    auto all = HC_TRY(read_messages(place_, options_));
    Message message;
    auto got = all->take(message);
    for (; got && *got == Got::Message; got = all->take(message)) {
      info.end = all->log_time();
      if (info.messages++ > 0) continue;
      info.begin = info.end;
      info.type = name(message.header.info.type);
    }
    if (!got) info.status = got.error();
    return std::vector{std::move(info)};
  }

 private:
  /// Reads the next message into ahead_, unless it has one.
  Result<Got> read_ahead() {
    while (!ahead_) {
      Message message;
      auto got = source_->take(message);
      if (!got || *got != Got::Message) return got;
      if (times_.last == Time() && message.header.time == Time()) times_.add(first_time());
      times_.add(message.header.time);
      if (times_.last >= start_) ahead_ = std::move(message);
    }
    return Got::Message;
  }

  /// The first known time of a message near the beginning of the file. Only regular files
  /// can be read twice, not FIFOs and devices.
  Time first_time() {
    constexpr std::uint64_t kNear = std::uint64_t{64} << 20;  // [byte]
    std::error_code unknown;
    if (std::exchange(has_looked_, true) || place_.kind == Place::Kind::Link ||
        !std::filesystem::is_regular_file(place_.path, unknown))
      return {};
    auto source = hc::open_source(place_.uri, options_);
    Message message;
    while (source && (*source)->traffic().bytes < kNear) {
      auto got = (*source)->take(message);
      if (!got || *got != Got::Message) break;
      if (message.header.time != Time()) return message.header.time;
    }
    return {};
  }

  const Place place_;
  const LinkOptions options_;
  const std::unique_ptr<Source> source_;
  const std::string name_;
  LogTimes times_;
  Time start_;
  bool has_looked_ = false;
  std::optional<Message> ahead_;
};

}  // namespace

Result<std::unique_ptr<Reader>> read_messages(const Place& place, const LinkOptions& options) {
  auto source = hc::open_source(place.uri, options);
  if (!source) return source.error();
  return std::unique_ptr<Reader>(new MessageReader(place, options, std::move(*source)));
}

}  // namespace hc::record
