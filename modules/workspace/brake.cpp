// SPDX-License-Identifier: Apache-2.0
#include "brake.h"

#include <algorithm>

/// Finds or adds a source; null if there are too many that stop or guard.
Brake::Source* Brake::find(std::int32_t number) {
  if (const auto known = sources_.find(number); known != sources_.end()) return &known->second;
  if (sources_.size() >= kMostSources)
    std::erase_if(sources_, [](const auto& each) { return !each.second.matters(); });
  return sources_.size() < kMostSources ? &sources_[number] : nullptr;
}

hc::Status Brake::take(const Message& message, hc::MonotonicTime now) {
  if (message.word > kLeave)
    return hc::Error{hc::Code::Malformed, "a stop is 0, 1, 2 or 3, not " +
                                              std::to_string(static_cast<int>(message.word))};
  const bool is_stop = message.word == kStop;
  const bool is_timely = message.said > now - kOld && message.said <= now + kAhead;
  if (!is_stop && !is_timely)
    return hc::Error{hc::Code::Malformed, "its time is too old or in the future"};
  const auto said = is_stop ? now : std::min(message.said, now);
  if (message.word == kClearAll) clear_all(message.source, said);
  if (Source* source = find(message.source); source != nullptr) {
    hear(*source, message, said);
  } else {
    others_stop_ = others_stop_ || is_stop;
    if (!is_stop)
      return hc::Error{hc::Code::TooLarge, std::to_string(kMostSources) +
                                               " other sources stop or guard the robot already"};
  }
  return {};
}

void Brake::hear(Source& source, const Message& message, hc::MonotonicTime said) {
  const bool was_silent = source.is_silent(said);
  source.is_forgetful = source.is_forgetful || message.word == kLeave || message.seq < source.seq ||
                        (source.repeats && was_silent);
  source.repeats = message.word == source.word && !was_silent;
  source.word = message.word;
  source.seq = message.seq;
  source.heard = std::max(source.heard, said);
  if (message.word == kLeave) source.guards = false;
  if (message.word == kFree && source.repeats) source.guards = true;
  if (message.word == kFree && !source.is_forgetful) source.stops = false;
  if (message.word == kStop) {
    source.stops = true;
    source.is_forgetful = false;
  }
  if (!source.stops) source.is_forgetful = false;
}

/// @param by  the source that clears. Its own messages arrive in order; another source's stop may
/// have arrived before this message and yet be newer, and then holds.
void Brake::clear_all(std::int32_t by, hc::MonotonicTime said) {
  others_stop_ = false;
  for (auto& [number, source] : sources_) {
    source.guards = source.guards && !source.is_silent(said);
    if (number != by && source.heard > said) continue;
    source.stops = source.is_forgetful = false;
  }
}

void Brake::restore(const hc::Stops& stops) {
  for (const auto& [number, is_stop] : stops) {
    if (number == kOthers) {
      others_stop_ = is_stop;
      continue;
    }
    Source& source = sources_[number];
    source.stops = source.is_forgetful = is_stop;
    source.guards = !is_stop;
  }
}

hc::Stops Brake::stops() const {
  hc::Stops stops;
  for (const auto& [number, source] : sources_)
    if (source.matters()) stops[number] = source.stops;
  if (others_stop_) stops[kOthers] = true;
  return stops;
}

std::string Brake::reason(hc::MonotonicTime now) const {
  for (const auto& [number, source] : sources_)
    if (source.stops) return "stopped by " + name(number);
  if (others_stop_) return "stopped by a source beyond the limit";
  for (const auto& [number, source] : sources_)
    if (source.guards && source.is_silent(now))
      return name(number) + " is silent: its stop could not arrive";
  return "";
}
