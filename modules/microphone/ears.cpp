// SPDX-License-Identifier: Apache-2.0
#include "ears.h"

#include <algorithm>
#include <utility>

using hc::Result;
using hc::audio::Converter;
using hc::audio::WavReader;

Result<FileEar> FileEar::open(const std::string& path, const hc::audio::Format& format,
                              hc::Time start) {
  auto reader = HC_TRY(WavReader::open(path));
  auto converter = HC_TRY(Converter::make(Converter::Scalar::I16, reader.format(), format));
  return FileEar(std::move(reader), std::move(converter), format, start);
}

Result<std::optional<Piece>> FileEar::next() {
  const auto frames = static_cast<std::size_t>(format_.rate / kPiecesPerSecond);
  const std::size_t wanted = frames * static_cast<std::size_t>(format_.channels);
  std::vector<std::int16_t> read(frames * static_cast<std::size_t>(reader_.format().channels));
  while (ready_.size() < wanted && !is_finished_) {
    auto got = HC_TRY(reader_.read(read));
    if (got == 0) {
      converter_.finish();
      is_finished_ = true;
    } else {
      converter_.put(std::span(std::as_const(read))
                         .first(got * static_cast<std::size_t>(reader_.format().channels)));
    }
    const auto more = converter_.take();
    ready_.insert(ready_.end(), more.begin(), more.end());
  }
  if (ready_.empty()) return std::optional<Piece>();
  const std::size_t size = std::min(wanted, ready_.size());
  auto piece = hc::audio::message_of(std::span(std::as_const(ready_)).first(size), format_);
  piece.header.time = start_ + hc::audio::duration_of(sent_, format_.rate);
  sent_ += piece.header.width;
  ready_.erase(ready_.begin(), ready_.begin() + static_cast<std::ptrdiff_t>(size));
  return std::optional(std::move(piece));
}

std::optional<Piece> DeviceEar::next() {
  if (capture_ == nullptr) return std::nullopt;
  auto heard = capture_->take(std::chrono::milliseconds(0));
  if (!heard) return std::nullopt;
  heard_at_ = hc::SystemClock().monotonic();
  if (std::exchange(is_silent_, false)) log_(hc::Level::Info, "microphone resumed");
  if (capture_->lost() > 0 && !std::exchange(has_lost_, true))
    log_(hc::Level::Warning, "sound dropped: not read in time (further drops are not logged)");
  auto piece = hc::audio::message_of(heard->samples, format_);
  piece.header.time = times_.stamp(piece.header.width, heard->time);
  return piece;
}

void DeviceEar::look() {
  const auto now = hc::SystemClock().monotonic();
  if (capture_ != nullptr && !capture_->is_there()) {
    capture_.reset();
    is_silent_ = false;
    is_missing_ = true;
    log_(hc::Level::Warning, "microphone disconnected; retrying");
  }
  if (capture_ != nullptr) {
    if (now - heard_at_ > kTimeout && !std::exchange(is_silent_, true))
      log_(hc::Level::Warning, "microphone unresponsive; waiting");
    return;
  }
  if (!backoff_.is_due(now)) return;
  auto opened = hc::audio::Capture::open(device_, format_, format_.rate / kPiecesPerSecond);
  if (!opened) {
    backoff_.fail(now);
    if (!std::exchange(is_missing_, true))
      log_(hc::Level::Warning, opened.error().detail + "; retrying");
    return;
  }
  capture_ = std::move(*opened);
  heard_at_ = now;
  backoff_.reset();
  if (std::exchange(is_missing_, false)) log_(hc::Level::Info, "microphone connected");
}
