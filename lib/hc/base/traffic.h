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
  std::uint64_t kept_back = 0;
  /// Messages dropped because a newer one arrived while the reader was slow (`keep`),
  std::uint64_t superseded = 0;
  /// … while they were delayed (`rate`),
  std::uint64_t over_rate = 0;
  /// … because there was no memory for them (`memory`),
  std::uint64_t over_memory = 0;
  /// … because the connection was lost while they were on their way (`reconnect`).
  std::uint64_t cut = 0;
  /// … because the reader had taken nothing for so long (`timeout`).
  std::uint64_t timed_out = 0;
  /// Messages that came and were dropped: damaged, unfit, or saying what cannot be.
  std::uint64_t bad = 0;

  Traffic& operator+=(const Traffic& other);
  /// Messages that did not arrive.
  [[nodiscard]] std::uint64_t lost() const {
    return superseded + over_rate + over_memory + cut + timed_out;
  }
};

/// Its members in the order in which a module reports them.
constexpr std::array kTrafficMembers = {
    &Traffic::messages,   &Traffic::bytes,     &Traffic::kept_back,
    &Traffic::superseded, &Traffic::over_rate, &Traffic::over_memory,
    &Traffic::cut,        &Traffic::timed_out, &Traffic::bad};

inline Traffic& Traffic::operator+=(const Traffic& other) {
  for (auto member : kTrafficMembers) this->*member += other.*member;
  return *this;
}

}  // namespace hc
