// SPDX-License-Identifier: Apache-2.0
#include "router.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <hc/base/format.h>

SeenBefore::Entry* SeenBefore::set_of(Window& window, std::int64_t seq) {
  auto sets = static_cast<std::int64_t>(window.entries.size() / kWays);
  return window.entries.data() + static_cast<std::size_t>(seq % sets) * kWays;
}

/// Forgets the source that has been silent longest.
void SeenBefore::forget_silent(const Window* but) {
  auto silent = windows_.end();
  for (auto window = windows_.begin(); window != windows_.end(); ++window)
    if (&window->second != but &&
        (silent == windows_.end() || window->second.latest < silent->second.latest))
      silent = window;
  if (silent == windows_.end()) return;
  room_ -= silent->second.entries.size();
  windows_.erase(silent);
}

SeenBefore::Window& SeenBefore::window_of(std::int32_t src, hc::MonotonicTime now) {
  if (last_ == nullptr || src != last_src_) {
    auto found = windows_.find(src);
    if (found == windows_.end()) {
      if (room_ + kMin > max_) forget_silent(nullptr);
      found = windows_.emplace(src, Window{std::vector<Entry>(kMin), now}).first;
      room_ += kMin;
    }
    last_src_ = src;
    last_ = &found->second;
  }
  last_->latest = now;
  return *last_;
}

/// Doubles a window; false if it is at its maximum.
bool SeenBefore::grow(Window& window) {
  const std::size_t size = window.entries.size();
  if (2 * size > max_of_source_) return false;
  while (room_ + size > max_ && windows_.size() > 1) forget_silent(&window);
  if (room_ + size > max_) return false;
  // The entries of one set are distributed over two, so each fits.
  auto old = std::exchange(window.entries, std::vector<Entry>(2 * size));
  room_ += size;
  for (const Entry& entry : old) {
    if (entry.seq < 0) continue;
    Entry* set = set_of(window, entry.seq);
    *std::find_if(set, set + kWays, [](const Entry& other) { return other.seq < 0; }) = entry;
  }
  return true;
}

bool SeenBefore::insert(const hc::Header& header, hc::MonotonicTime now) {
  Window& window = window_of(header.src, now);
  while (true) {
    Entry* set = set_of(window, header.seq);
    Entry* oldest = set;
    for (Entry* entry = set; entry != set + kWays; ++entry) {
      bool is_kept = entry->seq >= 0 && now - entry->came < remember_;
      if (is_kept && entry->seq == header.seq && entry->time == header.time &&
          entry->dst == header.dst)
        return true;
      if (!is_kept) entry->seq = -1;
      if (entry->seq < 0 || (oldest->seq >= 0 && std::tie(entry->came, entry->seq) <
                                                     std::tie(oldest->came, oldest->seq)))
        oldest = entry;
    }
    if (oldest->seq >= 0 && grow(window)) continue;
    *oldest = {header.seq, header.time, now, header.dst};
    return false;
  }
}

std::string RouterCounts::text() const {
  return hc::format(
      "{} passed; dropped: {} ttl, {} seen before, {} without a route, {} without an address",
      passed, ttl, seen, no_route, no_address);
}

bool Router::admit(hc::Header& header, hc::MonotonicTime now) {
  if (header.ttl <= 1) {
    ++counts_.ttl;
    return false;
  }
  if (seen_.insert(header, now)) {
    ++counts_.seen;
    return false;
  }
  --header.ttl;
  return true;
}

void Router::sent(const hc::Header& header, std::size_t links) {
  if (links > 0)
    ++counts_.passed;
  else
    ++(header.dst == 0 ? counts_.no_address : counts_.no_route);
}
