// SPDX-License-Identifier: Apache-2.0
#pragma once
// Counters of a link. Pure.

#include <array>
#include <cstdint>

namespace hc {

/// Messages sent or received over a link, and those lost.
struct Traffic {
  std::uint64_t messages = 0;
  /// As on the wire; without one, the elements (inproc), or the elements and the header (shm).
  std::uint64_t bytes = 0;
  /// Messages delayed by `rate` or `bandwidth`: sent later, or also counted as dropped.
  std::uint64_t delayed = 0;
  /// Messages dropped because a newer one arrived while the reader was slow (`keep`).
  std::uint64_t dropped_newer = 0;
  /// Messages dropped because a newer one arrived while they were delayed (`rate`, `bandwidth`), or
  /// nothing had changed (`idle_rate`).
  std::uint64_t throttled = 0;
  /// Messages dropped because the memory of the link was used up (`memory`).
  std::uint64_t dropped_memory = 0;
  /// Messages dropped because the connection was lost while they were in transit (`reconnect`).
  std::uint64_t dropped_disconnect = 0;
  /// Messages dropped because the reader had read nothing for `timeout`.
  std::uint64_t dropped_timeout = 0;
  /// Messages that arrived and were dropped as damaged, of an unsuitable type, or inconsistent.
  std::uint64_t bad = 0;

  Traffic& operator+=(const Traffic& other);
  /// Messages that did not arrive.
  [[nodiscard]] std::uint64_t lost() const {
    return dropped_newer + throttled + dropped_memory + dropped_disconnect + dropped_timeout;
  }
};

/// The counters in the order in which a module reports them.
constexpr std::array kTrafficMembers = {
    &Traffic::messages,           &Traffic::bytes,           &Traffic::delayed,
    &Traffic::dropped_newer,      &Traffic::throttled,       &Traffic::dropped_memory,
    &Traffic::dropped_disconnect, &Traffic::dropped_timeout, &Traffic::bad};

inline Traffic& Traffic::operator+=(const Traffic& other) {
  for (auto member : kTrafficMembers) this->*member += other.*member;
  return *this;
}

}  // namespace hc
