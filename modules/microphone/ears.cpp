// SPDX-License-Identifier: Apache-2.0
#include "ears.h"

#include <poll.h>

#include <algorithm>
#include <utility>

using hc::Result;
using hc::audio::Converter;
using hc::audio::WavReader;

Result<FileEar> FileEar::open(const std::string& path, const hc::audio::Format& format) {
  auto reader = WavReader::open(path);
  if (!reader) return reader.error();
  auto converter = Converter::make(Converter::Scalar::I16, reader->format(), format);
  if (!converter) return converter.error();
  return FileEar(std::move(*reader), std::move(*converter),
                 static_cast<std::size_t>(format.channels));
}

Result<std::vector<std::int16_t>> FileEar::next(std::size_t frames) {
  const std::size_t wanted = frames * channels_;
  std::vector<std::int16_t> read(frames * static_cast<std::size_t>(reader_.format().channels));
  while (ready_.size() < wanted && !is_finished_) {
    auto got = reader_.read(read);
    if (!got) return got.error();
    if (*got == 0) {
      converter_.finish();
      is_finished_ = true;
    } else {
      converter_.put(std::span(std::as_const(read))
                         .first(*got * static_cast<std::size_t>(reader_.format().channels)));
    }
    const auto more = converter_.take();
    ready_.insert(ready_.end(), more.begin(), more.end());
  }
  const auto end = ready_.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, ready_.size()));
  std::vector<std::int16_t> piece(ready_.begin(), end);
  ready_.erase(ready_.begin(), end);
  return piece;
}

std::optional<Piece> DeviceEar::next(std::chrono::milliseconds timeout, int stop) {
  const hc::SystemClock clock;
  look(clock.monotonic());
  if (capture_ == nullptr) {
    pollfd waiting{stop, POLLIN, 0};
    ::poll(&waiting, 1, static_cast<int>(timeout.count()));
    return std::nullopt;
  }
  auto heard = capture_->take(timeout, stop);
  const auto now = clock.monotonic();
  if (!heard) {
    if (now - heard_at_ > kPatience && !std::exchange(told_silent_, true))
      tell_("the microphone gives nothing; waits for it");
    return std::nullopt;
  }
  heard_at_ = now;
  if (std::exchange(told_silent_, false)) tell_("the microphone gives sound again");
  if (!told_lost_ && capture_->lost() > 0) {
    told_lost_ = true;
    tell_("sound is lost, since nobody takes it in time");
  }
  const auto frames = static_cast<std::int64_t>(heard->samples.size()) / format_.channels;
  return Piece{std::move(heard->samples), times_.stamp(frames, heard->time)};
}

void DeviceEar::look(hc::MonotonicTime now) {
  if (capture_ != nullptr && !capture_->is_there()) {
    capture_.reset();
    told_silent_ = false;
    tell_("the microphone has gone; looks for it");
    told_missing_ = true;
  }
  if (capture_ != nullptr || !retry_.is_due(now)) return;
  auto opened = hc::audio::Capture::open(device_, format_, frames_);
  if (!opened) {
    retry_.failed(now);
    if (!told_missing_) tell_(opened.error().detail + "; looks for it");
    told_missing_ = true;
    return;
  }
  capture_ = std::move(*opened);
  heard_at_ = now;
  retry_.succeeded();
  if (was_there_ || told_missing_) tell_("the microphone is there");
  was_there_ = true;
  told_missing_ = false;
}
