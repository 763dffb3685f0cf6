// SPDX-License-Identifier: Apache-2.0
#pragma once
// How much went over a link. Pure.

#include <array>
#include <cstdint>

namespace hc {

/// What went over a link, and what did not.
struct Traffic {
  std::uint64_t messages = 0;
  /// Sent, as on the wire; elements alone where there is none (inproc), with their header (shm).
  std::uint64_t bytes = 0;
  /// Messages delayed by `rate`: they went later, or are among the dropped.
  std::uint64_t delayed = 0;
  /// Messages dropped because a newer one arrived while the reader was slow (`keep`),
  std::uint64_t dropped_newer = 0;
  /// … while they were delayed (`rate`),
  std::uint64_t throttled = 0;
  /// … because there was no memory for them (`memory`),
  std::uint64_t dropped_memory = 0;
  /// … because the connection was lost while they were on their way (`reconnect`).
  std::uint64_t dropped_disconnect = 0;
  /// … because the reader had taken nothing for so long (`timeout`).
  std::uint64_t dropped_timeout = 0;
  /// Messages that came and were dropped: damaged, unfit, or saying what cannot be.
  std::uint64_t bad = 0;

  Traffic& operator+=(const Traffic& other);
  /// Messages that did not arrive.
  [[nodiscard]] std::uint64_t lost() const {
    return dropped_newer + throttled + dropped_memory + dropped_disconnect + dropped_timeout;
  }
};

/// Its members in the order in which a module reports them.
constexpr std::array kTrafficMembers = {
    &Traffic::messages,           &Traffic::bytes,           &Traffic::delayed,
    &Traffic::dropped_newer,      &Traffic::throttled,       &Traffic::dropped_memory,
    &Traffic::dropped_disconnect, &Traffic::dropped_timeout, &Traffic::bad};

inline Traffic& Traffic::operator+=(const Traffic& other) {
  for (auto member : kTrafficMembers) this->*member += other.*member;
  return *this;
}

}  // namespace hc
