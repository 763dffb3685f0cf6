// SPDX-License-Identifier: Apache-2.0
#include "publisher.h"

#include <chrono>
#include <utility>

#include <hc/base/clock.h>

namespace web = hc::web;

web::Bytes bytes_of(const hc::ros::Pieces& pieces) {
  std::string bytes;
  bytes.reserve(pieces.size());
  for (const auto& piece : {pieces.head, pieces.body, pieces.tail})
    bytes.append(reinterpret_cast<const char*>(piece.data()), piece.size());
  return std::make_shared<const std::string>(std::move(bytes));
}

Publisher::Publisher(hc::RunningGraph graph, Channel channel,
                     std::map<std::int32_t, std::string> frames, web::Post post,
                     Callbacks callbacks)
    : channel_(std::move(channel)),
      post_(std::move(post)),
      shared_(std::make_shared<Shared>()),
      tap_((encoder_.frames = std::move(frames), shared_->callbacks = std::move(callbacks),
            std::move(graph)),
           channel_.port,
           {.message = [this](const hc::Message& message) { take(message); },
            .end = [this](const std::string& why,
                          bool) { call([why](const Callbacks& to) { to.end(why); }); }}) {}

void Publisher::call(std::function<void(const Callbacks&)> what) const {
  post_([weak = std::weak_ptr(shared_), what = std::move(what)] {
    if (const auto shared = weak.lock()) what(shared->callbacks);
  });
}

void Publisher::take(const hc::Message& message) {
  if (shared_->waiting >= kMaxWaiting) {
    ++shared_->dropped;
    return;
  }
  const auto pieces = encoder_.encode_any(channel_.type, message);
  if (!pieces) {
    // A message that does not match its port. Each error is reported once.
    if (std::exchange(failed_, pieces.error().detail) != failed_)
      call([why = failed_](const Callbacks& to) { to.end(why); });
    return;
  }
  const hc::Time time =
      message.header.time != hc::Time() ? message.header.time : hc::SystemClock().wall();
  auto bytes = bytes_of(*pieces);
  shared_->waiting += bytes->size();
  call([payload = Payload{time, std::move(bytes)},
        &waiting = shared_->waiting](const Callbacks& callbacks) {
    waiting -= payload.bytes->size();
    callbacks.message(payload);
  });
}
