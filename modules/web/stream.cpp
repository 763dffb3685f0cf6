// SPDX-License-Identifier: Apache-2.0
#include "stream.h"

#include <algorithm>
#include <utility>

#include <hc/base/text.h>
#include <hc/base/time.h>
#include <hc/compress/compress.h>
#include <hc/mtp/codec.h>

namespace {

constexpr std::chrono::milliseconds kHeader{500};       // between header lines
constexpr std::chrono::milliseconds kBetweenKeys{500};  // of VP8
constexpr int kQuality = 80;                            // of JPEG
constexpr int kNoStream = 4404;                         // close code, as kEnd

template <typename Number>
bool read_number(std::string_view text, Number max, Number& number) {
  Number read{};
  if (!hc::read_number(text, read) || !(read >= 0) || read > max) return false;
  number = read;
  return true;
}

/// The bytes of a message, with text encoding replaced by binary.
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
                           "\" is not as=raw, as=jpeg, as=vp8, width=0 … 65500 or rate=0 … 1000"};
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

void Stream::post(const std::shared_ptr<Viewer>& viewer,
                  std::function<void(const std::shared_ptr<Viewer>&)> call) {
  post_([this, weak = std::weak_ptr(viewer), call = std::move(call)] {
    if (const auto still = weak.lock(); still && sockets_.contains(still)) call(still);
  });
}

void Stream::view(const Wanted& wanted, std::shared_ptr<web::WebSocket> socket) {
  auto& events = *socket;
  const auto viewer = std::make_shared<Viewer>(Viewer{wanted});
  sockets_.emplace(viewer, std::move(socket));
  events.on_close = [this, weak = std::weak_ptr(viewer)] {
    if (const auto still = weak.lock()) remove(still);
  };
  events.on_text = [this, weak = std::weak_ptr(viewer)](std::string_view said) {
    if (const auto still = weak.lock()) hear(still, said);
  };
  const std::lock_guard lock(mutex_);
  viewers_.push_back(viewer);
  if (!ended_.empty()) close_soon(viewer, ended_as_, ended_);
  tap_->wake();
}

void Stream::hear(const std::shared_ptr<Viewer>& viewer, std::string_view said) {
  // Only this thread changes `wanted`, so it may be read without the mutex.
  const auto changed =
      said == "ok" ? hc::Result<Wanted>(viewer->wanted) : parse_wanted(said, viewer->wanted);
  if (!changed) return close(viewer, kPolicy, changed.error().detail);
  const std::lock_guard lock(mutex_);
  if (said == "ok" && viewer->under_way > 0) --viewer->under_way;
  if (changed->form != viewer->wanted.form || changed->width != viewer->wanted.width)
    viewer->has_changed = true;
  viewer->wanted = *changed;
  tap_->wake();
}

void Stream::remove(const std::shared_ptr<Viewer>& viewer) {
  sockets_.erase(viewer);
  const std::lock_guard lock(mutex_);
  std::erase(viewers_, viewer);
}

void Stream::close(const std::shared_ptr<Viewer>& viewer, int code, const std::string& why) {
  sockets_.at(viewer)->close(code, why);
  remove(viewer);
}

void Stream::close_soon(const std::shared_ptr<Viewer>& viewer, int code, const std::string& why) {
  post(viewer, [this, code, why](const auto& still) { close(still, code, why); });
}

void Stream::close(const std::string& why) {
  for (const auto& [viewer, socket] : std::map(sockets_)) close(viewer, kEnd, why);
}

void Stream::end(const std::string& why, bool is_error) {
  const std::lock_guard lock(mutex_);
  ended_ = why;
  ended_as_ = is_error ? kNoStream : kEnd;
  for (const auto& viewer : viewers_) close_soon(viewer, ended_as_, why);
}

Stream::Clock::time_point Stream::serve() {
  const auto now = Clock::now();
  auto next = Clock::time_point::max();
  if (number_ == 0) return next;
  struct Alike {
    Wanted wanted;
    Viewers viewers;
  };
  std::map<std::pair<Form, int>, Alike> all;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(videos_, [&](const auto& video) {
      return std::ranges::none_of(viewers_, [&](const auto& viewer) {
        return viewer->wanted.form == Form::Vp8 && viewer->wanted.width == video.first;
      });
    });
    for (const auto& viewer : viewers_) {
      if (std::exchange(viewer->has_changed, false)) viewer->frame = 0;
      if (viewer->seen == number_ || viewer->under_way >= kMaxUnderWay) continue;
      if (now < viewer->due) {
        next = std::min(next, viewer->due);
        continue;
      }
      if (viewer->wanted.rate > 0)
        viewer->due = std::max(viewer->due + hc::duration(1 / viewer->wanted.rate), now);
      auto& [wanted, viewers] = all[{viewer->wanted.form, viewer->wanted.width}];
      wanted = viewer->wanted;
      viewers.push_back(viewer);
      ++viewer->under_way;
    }
  }
  for (const auto& [what, alike] : all) {
    for (const auto& viewer : alike.viewers) viewer->seen = number_;
    serve_alike(alike.wanted, alike.viewers);
  }
  return next;
}

void Stream::serve_alike(const Wanted& wanted, const Viewers& viewers) {
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
    const bool needs_key = std::ranges::any_of(
        viewers, [&](const auto& viewer) { return viewer->frame != video->frames; });
    made = video->encoder.encode(*made, needs_key && now >= video->key_due);
    ++video->frames;
    is_key = made && is_key_frame(*made);
    if (is_key) video->key_due = now + kBetweenKeys;
  }
  if (!made) {
    for (const auto& viewer : viewers) close_soon(viewer, kNoStream, made.error().detail);
    return;
  }
  const web::Bytes bytes = bytes_of(*made);
  const std::string header = hc::text(newest_.header);
  for (const auto& viewer : viewers) {
    if (video != nullptr) {
      if (!is_key && viewer->frame + 1 != video->frames) {  // it missed a frame
        const std::lock_guard lock(mutex_);
        --viewer->under_way;
        continue;
      }
      viewer->frame = video->frames;
    }
    const bool has_header = now >= viewer->header_due;
    if (has_header) viewer->header_due = now + kHeader;
    post(viewer, [this, bytes, text = has_header ? header : std::string()](const auto& still) {
      const auto& socket = sockets_.at(still);
      if (!text.empty()) socket->send_text(text);
      socket->send(bytes);
    });
  }
}
