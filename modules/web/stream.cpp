// SPDX-License-Identifier: Apache-2.0
#include "stream.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <hc/compress/compress.h>
#include <hc/mtp/codec.h>

namespace {

constexpr std::chrono::milliseconds kHeader{500};       // between header lines
constexpr std::chrono::milliseconds kBetweenKeys{500};  // of VP8, for a page that missed frames
constexpr int kQuality = 80;                            // of JPEG
constexpr int kNoStream = 4404;                         // as kEnd

template <typename Number>
bool read_number(std::string_view text, Number max, Number& number) {
  Number read{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
  if (error != std::errc() || end != text.data() + text.size() || !(read >= 0) || read > max)
    return false;
  number = read;
  return true;
}

/// A message in binary encoding, which it may be in already.
web::Bytes bytes_of(hc::Message message) {
  if (message.header.info.encoding == hc::Encoding::Text)
    message.header.info.encoding = hc::Encoding::Binary;
  return std::make_shared<const std::string>(hc::encode(message));
}

}  // namespace

hc::Result<Wanted> parse_wanted(std::string_view options, Wanted wanted) {
  constexpr int kMaxWidth = 65500;
  constexpr double kMaxRate = 1000;
  while (!options.empty()) {
    const auto option = options.substr(0, options.find('&'));
    options.remove_prefix(std::min(options.size(), option.size() + 1));
    const auto equals = std::min(option.find('='), option.size());
    const auto key = option.substr(0, equals);
    const auto value = option.substr(std::min(option.size(), equals + 1));
    bool is_known = true;
    if (key == "as" && value == "raw")
      wanted.form = Form::Raw;
    else if (key == "as" && value == "jpeg")
      wanted.form = Form::Jpeg;
    else if (key == "as" && value == "vp8")
      wanted.form = Form::Vp8;
    else if (key == "width")
      is_known = read_number(value, kMaxWidth, wanted.width);
    else if (key == "rate")
      is_known = read_number(value, kMaxRate, wanted.rate);
    else
      is_known = false;
    if (!is_known)
      return hc::Error{hc::Code::Invalid,
                       "\"" + std::string(option) +
                           "\" is none of as=raw, as=jpeg, as=vp8, width=0 … 65500, rate=0 … 1000"};
  }
  return wanted;
}

Stream::Stream(hc::RunningGraph graph, std::string port, web::Post post)
    : post_(std::move(post)),
      tap_(std::in_place, std::move(graph), std::move(port),
           hc::Tap::Callbacks{
               .message =
                   [this](const hc::Message& message) {
                     newest_ = message.keep();
                     ++number_;
                   },
               .idle = [this] { return serve(); },
               .end = [this](const std::string& why, bool is_error) { end(why, is_error); }}) {}

void Stream::post(const std::shared_ptr<Seat>& seat,
                  std::function<void(const std::shared_ptr<Seat>&)> call) {
  post_([this, weak = std::weak_ptr(seat), call = std::move(call)] {
    if (const auto still = weak.lock(); still && sockets_.contains(still)) call(still);
  });
}

void Stream::view(const Wanted& wanted, std::shared_ptr<web::WebSocket> socket) {
  auto& events = *socket;
  const auto seat = std::make_shared<Seat>(Seat{wanted});
  sockets_.emplace(seat, std::move(socket));
  events.on_close = [this, weak = std::weak_ptr(seat)] {
    if (const auto still = weak.lock()) remove(still);
  };
  events.on_text = [this, weak = std::weak_ptr(seat)](std::string_view said) {
    if (const auto still = weak.lock()) hear(still, said);
  };
  const std::lock_guard lock(mutex_);
  seats_.push_back(seat);
  if (!ended_.empty()) close_soon(seat, ended_as_, ended_);
  tap_->wake();
}

void Stream::hear(const std::shared_ptr<Seat>& seat, std::string_view said) {
  // This thread alone changes what is wanted.
  const auto changed =
      said == "ok" ? hc::Result<Wanted>(seat->wanted) : parse_wanted(said, seat->wanted);
  if (!changed) return close(seat, kPolicy, changed.error().detail);
  const std::lock_guard lock(mutex_);
  if (said == "ok" && seat->under_way > 0) --seat->under_way;
  if (changed->form != seat->wanted.form || changed->width != seat->wanted.width)
    seat->has_changed = true;
  seat->wanted = *changed;
  tap_->wake();
}

void Stream::remove(const std::shared_ptr<Seat>& seat) {
  sockets_.erase(seat);
  const std::lock_guard lock(mutex_);
  std::erase(seats_, seat);
}

void Stream::close(const std::shared_ptr<Seat>& seat, int code, const std::string& why) {
  sockets_.at(seat)->close(code, why);
  remove(seat);
}

void Stream::close_soon(const std::shared_ptr<Seat>& seat, int code, const std::string& why) {
  post(seat, [this, code, why](const auto& still) { close(still, code, why); });
}

void Stream::close(const std::string& why) {
  for (const auto& [seat, socket] : std::map(sockets_)) close(seat, kEnd, why);
}

void Stream::end(const std::string& why, bool is_error) {
  const std::lock_guard lock(mutex_);
  ended_ = why;
  ended_as_ = is_error ? kNoStream : kEnd;
  for (const auto& seat : seats_) close_soon(seat, ended_as_, why);
}

Stream::Clock::time_point Stream::serve() {
  const auto now = Clock::now();
  auto next = Clock::time_point::max();
  if (number_ == 0) return next;
  struct Alike {
    Wanted wanted;
    Seats seats;
  };
  std::map<std::pair<Form, int>, Alike> all;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(videos_, [&](const auto& video) {
      return std::ranges::none_of(seats_, [&](const auto& seat) {
        return seat->wanted.form == Form::Vp8 && seat->wanted.width == video.first;
      });
    });
    for (const auto& seat : seats_) {
      if (std::exchange(seat->has_changed, false)) seat->frame = 0;
      if (seat->seen == number_ || seat->under_way >= kMaxUnderWay) continue;
      if (now < seat->due) {
        next = std::min(next, seat->due);
        continue;
      }
      if (seat->wanted.rate > 0)
        seat->due = std::max(seat->due + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(1 / seat->wanted.rate)),
                             now);
      auto& [wanted, seats] = all[{seat->wanted.form, seat->wanted.width}];
      wanted = seat->wanted;
      seats.push_back(seat);
      ++seat->under_way;
    }
  }
  for (const auto& [what, alike] : all) {
    for (const auto& seat : alike.seats) seat->seen = number_;
    serve_alike(alike.wanted, alike.seats);
  }
  return next;
}

void Stream::serve_alike(const Wanted& wanted, const Seats& seats) {
  const auto now = Clock::now();
  auto made = hc::expand(newest_);
  if (made) made = scaled(*made, wanted.width);
  const bool is_image = made && is_picture(made->header);
  if (is_image && wanted.form == Form::Jpeg && made->header.info.components != 4)
    made = hc::compress(*made, hc::Encoding::Jpeg, kQuality);
  Video* video = nullptr;
  bool is_key = true;
  if (is_image && wanted.form == Form::Vp8) {
    video = &videos_[wanted.width];
    const bool needs_key =
        std::ranges::any_of(seats, [&](const auto& seat) { return seat->frame != video->frames; });
    made = video->encoder.encode(*made, needs_key && now >= video->key_due);
    ++video->frames;
    is_key = made && is_key_frame(*made);
    if (is_key) video->key_due = now + kBetweenKeys;
  }
  if (!made) {
    for (const auto& seat : seats) close_soon(seat, kNoStream, made.error().detail);
    return;
  }
  const web::Bytes bytes = bytes_of(*made);
  const std::string header = hc::text(newest_.header);
  for (const auto& seat : seats) {
    if (video != nullptr) {
      if (!is_key && seat->frame + 1 != video->frames) {  // it could not show this one
        const std::lock_guard lock(mutex_);
        --seat->under_way;
        continue;
      }
      seat->frame = video->frames;
    }
    const bool has_header = now >= seat->header_due;
    if (has_header) seat->header_due = now + kHeader;
    post(seat, [this, bytes, text = has_header ? header : std::string()](const auto& still) {
      const auto& socket = sockets_.at(still);
      if (!text.empty()) socket->send_text(text);
      socket->send(bytes);
    });
  }
}
