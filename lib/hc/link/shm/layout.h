// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a publisher and its readers share: memory of the publisher that readers map read-only, and a
// page of each reader that the publisher maps read-only. Every word has one writing process.
// Internal.
//
// The publisher's memory is a head, a ring of cells and room for slots. A message at position p
// (0, 1, 2, …) is in cell p modulo kCells: its header, the same line of text as on a wire, and its
// elements when they are small; large ones stand in a slot and may be read in place. A cell is
// readable when its stamp is p + 1 and `oldest` is at most p.
//
// Who writes a word and then looks at one of the other side's must not have the two exchanged by
// the processor: both sides put a sequentially consistent fence in between. There are three such
// pairs, named where they stand in the code:
//   wake:  publish, look whether a reader sleeps    | say that one sleeps, look for a message
//   room:  say that one waits for room, look for it | give room, look whether it is waited for
//   hold:  withdraw a cell, look who holds its slot | hold a slot, look whether it is withdrawn

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hc/os/shared_memory.h>

namespace hc::internal {

constexpr std::size_t kLine = 64;  ///< what caches exchange [byte]; also the alignment of elements
constexpr std::uint64_t kCells = 2048;
constexpr std::size_t kCellBytes = 256;
/// Both sides fetch the start of a cell so many messages ahead: it comes from the other's cache,
/// which takes longer than all else.
constexpr std::uint64_t kFetchAhead = 8;
constexpr std::size_t kFetchBytes = 2 * kLine;
constexpr std::size_t kMostHeld = 64;     ///< slots that one reader may hold
constexpr std::size_t kMostReaders = 64;  ///< of one publisher

/// A message, or where its elements are.
struct alignas(kLine) Cell {
  static constexpr std::size_t kWords = kCellBytes / sizeof(std::uint64_t) - 3;
  static constexpr std::size_t kTextBytes = kWords * sizeof(std::uint64_t);

  SharedWord<std::uint64_t> stamp;  ///< position + 1 of the message; 0: never used
  SharedWord<std::uint64_t> slot;  ///< where the elements begin in the memory; 0: behind the header
  SharedWord<std::uint64_t> sizes;  ///< bytes of the elements · 2^16 + bytes of the header line
  /// The header line, and at the next word the elements if they are small.
  std::array<SharedWord<std::uint64_t>, kWords> text;

  /// Where in the text the elements begin.
  static constexpr std::size_t behind(std::size_t header_bytes) {
    return (header_bytes + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t) *
           sizeof(std::uint64_t);
  }
};
static_assert(sizeof(Cell) == kCellBytes);

/// The start of the publisher's memory; the rest of its first page is unused.
struct Head {
  alignas(kLine) SharedWord<std::uint64_t> published;  ///< positions below have been published
  /// Positions below have been withdrawn: their cells and slots may be used again.
  alignas(kLine) SharedWord<std::uint64_t> oldest;
  /// What the publisher waits for: 0 nothing, a reader's cursor at least here, or kAnyRoom: a slot
  /// that is let go of too.
  alignas(kLine) SharedWord<std::uint64_t> wanted;
  alignas(kLine) SharedWord<std::uint32_t> closed;  ///< 1: nothing more comes
  /// 1: nobody has slept for a while, and the publisher leaves the fence of "wake" out; who goes to
  /// sleep then has to order the stores of both sides.
  SharedWord<std::uint32_t> unfenced;

  static constexpr std::uint64_t kAnyRoom = 1;
};
static_assert(sizeof(Head) <= kPageBytes);

constexpr std::uint64_t kRingBegin = kPageBytes;                                ///< [byte]
constexpr std::uint64_t kSlotsBegin = kRingBegin + kCells * sizeof(Cell);       ///< [byte]
constexpr std::uint64_t kLeastMemory = kSlotsBegin + (std::uint64_t{1} << 20);  ///< [byte]

/// What a reader says to its publisher.
struct ReaderPage {
  /// The position that is taken next; kLeft: the reader takes no more, but may hold slots still.
  alignas(kLine) SharedWord<std::uint64_t> cursor;
  /// 0: awake; else a number, another each time the reader waits for a byte in its pipe.
  alignas(kLine) SharedWord<std::uint32_t> armed;
  alignas(kLine) SharedWord<std::uint32_t> progress;  ///< futex: changes when wanted room is given
  alignas(kLine) std::array<SharedWord<std::uint64_t>, kMostHeld> held;  ///< slots; 0: none

  static constexpr std::uint64_t kLeft = std::numeric_limits<std::uint64_t>::max();
};
static_assert(sizeof(ReaderPage) <= kPageBytes);

}  // namespace hc::internal
