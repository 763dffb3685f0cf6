// SPDX-License-Identifier: Apache-2.0
#include "player.h"

#include <poll.h>

#include <cmath>
#include <limits>
#include <vector>

#include <hc/mtp/matrix_view.h>

using hc::Status;
using hc::audio::Converter;
using hc::audio::Format;

namespace {

constexpr int kPoll = 5;  // how often the free space is checked [ms]

}  // namespace

template <typename T>
Status Player::play(std::span<const T> samples, const Format& format) {
  constexpr auto kScalar =
      std::is_same_v<T, float> ? Converter::Scalar::F32 : Converter::Scalar::I16;
  HC_TRY(prepare(kScalar, format));
  converter_->put(samples);
  return give_out();
}
template Status Player::play(std::span<const std::int16_t>, const Format&);
template Status Player::play(std::span<const float>, const Format&);

Status Player::play(const hc::Message& message, const Format& format) {
  if (message.header.info.scalar == hc::Scalar::F32) {
    auto samples = hc::view<float>(message);
    return samples ? play(samples->numbers(), format) : samples.error();
  }
  auto samples = hc::view<std::int16_t>(message);
  return samples ? play(samples->numbers(), format) : samples.error();
}

/// Prepares a converter for a format; first plays the rest of the previous one.
Status Player::prepare(Converter::Scalar scalar, const Format& format) {
  if (!format_)
    format_ = Format{options_.rate > 0 ? options_.rate : format.rate,
                     options_.channels > 0 ? options_.channels : format.channels};
  if (!converter_ || !converter_->takes(scalar, format)) {
    auto made = HC_TRY(Converter::make(scalar, format, *format_));
    if (converter_) {
      converter_->finish();
      HC_TRY(give_out());
    }
    converter_.emplace(std::move(made));
  }
  return {};
}

/// Writes to the file. After an error, sound is only played.
void Player::save(std::span<const std::int16_t> samples) {
  if (options_.file.empty() || file_error_) return;
  Status written;
  if (writer_) written = writer_->write(samples);
  const bool is_full = !written && written.error().code == hc::Code::TooLarge;
  if (!writer_ || is_full) {
    auto begun = hc::audio::WavWriter::create(options_.file, *format_);
    if (begun && begun->path() != options_.file)
      log_(hc::Level::Notice, "continuing in " + begun->path());
    written = begun ? begun->write(samples) : begun.error();
    if (begun) writer_.emplace(std::move(*begun));
  }
  if (written) return;
  file_error_ = true;
  log_(hc::Level::Error, "recording of sound ended: " + written.error().detail);
}

Status Player::give_out() {
  const auto samples = converter_->take();
  if (samples.empty()) return {};
  save(samples);
  if (!options_.plays) return {};
  look();
  wait_until_at_most(options_.buffer);
  look();
  if (playback_ != nullptr && !stuck_at_)
    playback_->put(samples);
  else
    ++dropped_;
  return {};
}

void Player::wait_until_at_most(double seconds) {
  const hc::SystemClock clock;
  const auto most = std::llround(seconds * format_->rate);
  auto last = std::numeric_limits<std::int64_t>::max();
  auto since = clock.monotonic();
  while (playback_ != nullptr && playback_->is_there() && !stuck_at_) {
    const auto waiting = playback_->waiting();
    if (waiting <= most) return;
    if (waiting < last) since = clock.monotonic();
    last = waiting;
    if (clock.monotonic() - since > kTimeout) {
      stuck_at_ = waiting;
      return log_(hc::Level::Warning, "loudspeaker unresponsive; dropping sound");
    }
    pollfd stop{stop_, POLLIN, 0};
    if (::poll(&stop, 1, kPoll) != 0) return;
  }
}

void Player::look_whether_stuck() {
  if (!stuck_at_ || playback_->waiting() >= *stuck_at_) return;
  stuck_at_.reset();
  log_(hc::Level::Info,
       "loudspeaker resumed; dropped " + std::to_string(dropped_ - dropped_logged_) + " messages");
  dropped_logged_ = dropped_;
}

void Player::look() {
  if (!options_.plays || !format_) return;
  const auto now = hc::SystemClock().monotonic();
  if (playback_ != nullptr && !playback_->is_there()) {
    playback_.reset();
    stuck_at_.reset();
    is_missing_ = true;
    log_(hc::Level::Warning, "loudspeaker disconnected; dropping sound");
  }
  if (playback_ != nullptr) return look_whether_stuck();
  if (!backoff_.is_due(now)) return;
  auto opened = hc::audio::Playback::open(options_.device, *format_);
  if (!opened) {
    backoff_.fail(now);
    if (!is_missing_) log_(hc::Level::Warning, opened.error().detail + "; dropping sound");
    is_missing_ = true;
    return;
  }
  playback_ = std::move(*opened);
  backoff_.reset();
  if (is_missing_)
    log_(hc::Level::Info, "loudspeaker connected; dropped " +
                              std::to_string(dropped_ - dropped_logged_) + " messages");
  dropped_logged_ = dropped_;
  is_missing_ = false;
}

Status Player::finish() {
  if (!converter_) return {};
  converter_->finish();
  HC_TRY(give_out());
  wait_until_at_most(0);
  playback_.reset();
  return {};
}
