// SPDX-License-Identifier: Apache-2.0
#include "head_tracker.h"

#include <frames/messages.h>
#include <hc/base/uri.h>
#include <hc/base/words.h>

hc::TrackedHeadOptions HeadTrackerParameters::options() const {
  hc::HostPort place;
  if (!listen->empty()) place = hc::value_or_end(hc::parse_host_port(*listen));
  if (!listen->empty() && place.host.empty()) place.host = "127.0.0.1";
  const auto senders = hc::words_of(*sender);
  return {place.host,
          place.port,
          {senders.begin(), senders.end()},
          hc::duration(*silence),
          *centre_first};
}

HeadTracker::HeadTracker(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.every(std::chrono::seconds(1), [this] { send_address(); });
  module.every(hc::TrackedHead::kLook, [this] { pass(); });
  module.on(centre_, [this](const hc::Message&) { head_->centre(); });
  module.on_readable([this] { return head_->descriptor(); }, [this] { receive(); });
}

void HeadTracker::start() {
  if (parameters_.listen->empty()) module_.log("idle: `listen` names no port; opentrack's is 4242");
  head_.emplace(
      parameters_.options(),
      [this](hc::Level level, std::string_view line) { module_.log(line, level); },
      [this](const auto&... problem) { module_.log_once(problem...); });
  pass();
}

void HeadTracker::pass() {
  const bool listened = !head_->address().empty();
  hc::succeed_or_end(head_->pass(clock_.monotonic()));
  if (!listened && !head_->address().empty()) send_address();
}

void HeadTracker::receive() {
  const auto pose = hc::value_or_end(head_->receive(clock_.monotonic()));
  if (!pose) return;
  const auto& p = pose->pose.p;
  const auto angles = pose->pose.angles();
  rotation_.send({angles.x(), angles.y(), angles.z()}, pose->time);
  position_.send({p.x(), p.y(), p.z()}, pose->time);
}
