// SPDX-License-Identifier: Apache-2.0
#pragma once
// The memory that a publisher and its readers share: the publisher's memory, which readers map
// read-only, and a page of each reader, which the publisher maps read-only. Each word is written by
// one process only. Internal.
//
// The publisher's memory consists of a head, a ring of cells, and slots. The message at position p
// (0, 1, 2, …) is in cell p modulo kCells: its header, the same line of text as in a stream, and
// its elements if they are small; large ones are in a slot and can be read in place. A cell is
// valid if its stamp is p + 1 and `oldest` is at most p.
//
// In three places each side writes a word and then reads a word of the other side. The processor
// must not reorder the two, so both sides put a sequentially consistent fence between them.
// Comments in the code name the pairs:
//   wake:  publish a message, then check for sleepers | register as sleeper, then check for
//   messages room:  request room, then check for it            | release room, then check for
//   requests hold:  withdraw a cell, then check its holders    | hold a slot, then check that it is
//   valid

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hc/os/shared_memory.h>

namespace hc::internal {

constexpr std::size_t kLine = 64;  ///< a cache line, and the alignment of elements [byte]
constexpr std::uint64_t kCells = 2048;
constexpr std::size_t kCellBytes = 256;
/// Both sides prefetch the start of a cell this many messages ahead: to get it from the cache of
/// the other processor takes longer than everything else.
constexpr std::uint64_t kFetchAhead = 8;
constexpr std::size_t kFetchBytes = 2 * kLine;
constexpr std::size_t kMostHeld = 64;     ///< slots that one reader may hold
constexpr std::size_t kMostReaders = 64;  ///< of one publisher

/// A message: its header, and its elements or their slot.
struct alignas(kLine) Cell {
  static constexpr std::size_t kWords = kCellBytes / sizeof(std::uint64_t) - 3;
  static constexpr std::size_t kTextBytes = kWords * sizeof(std::uint64_t);

  SharedWord<std::uint64_t> stamp;  ///< position + 1 of the message; 0: never used
  SharedWord<std::uint64_t> slot;   ///< offset of the elements in the memory; 0: in the cell
  SharedWord<std::uint64_t> sizes;  ///< bytes of the elements · 2^16 + bytes of the header line
  /// The header line, followed by the elements if they are small, aligned to a word.
  std::array<SharedWord<std::uint64_t>, kWords> text;

  /// The offset of the elements in the text.
  static constexpr std::size_t behind(std::size_t header_bytes) {
    return (header_bytes + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t) *
           sizeof(std::uint64_t);
  }
};
static_assert(sizeof(Cell) == kCellBytes);

/// The start of the publisher's memory; the rest of its first page is unused.
struct Head {
  alignas(kLine) SharedWord<std::uint64_t> published;  ///< positions below are published
  SharedWord<std::uint32_t> processor;  ///< on which the publisher has published last
  /// Positions below are withdrawn: their cells and slots may be reused.
  alignas(kLine) SharedWord<std::uint64_t> oldest;
  /// 0, or the publisher waits until the cursor of a reader is at least this; kAnyRoom: or until a
  /// slot is released.
  alignas(kLine) SharedWord<std::uint64_t> wanted;
  alignas(kLine) SharedWord<std::uint32_t> closed;  ///< 1: no more messages
  /// 1: no reader has slept recently, and the publisher skips the fence of "wake"; a reader must
  /// then call order_everywhere() before it sleeps.
  SharedWord<std::uint32_t> unfenced;

  static constexpr std::uint64_t kAnyRoom = 1;
};
static_assert(sizeof(Head) <= kPageBytes);

constexpr std::uint64_t kRingBegin = kPageBytes;                                ///< [byte]
constexpr std::uint64_t kSlotsBegin = kRingBegin + kCells * sizeof(Cell);       ///< [byte]
constexpr std::uint64_t kLeastMemory = kSlotsBegin + (std::uint64_t{1} << 20);  ///< [byte]

/// The page of a reader.
struct ReaderPage {
  /// The next position to be taken; kLeft: the reader takes no more messages, but may hold slots.
  alignas(kLine) SharedWord<std::uint64_t> cursor;
  /// 0: awake; else a number, another each time the reader waits for a byte in its pipe.
  alignas(kLine) SharedWord<std::uint32_t> armed;
  alignas(kLine) SharedWord<std::uint32_t> progress;  ///< futex: changes when room is released
  alignas(kLine) std::array<SharedWord<std::uint64_t>, kMostHeld> held;  ///< slots; 0: unused

  static constexpr std::uint64_t kLeft = std::numeric_limits<std::uint64_t>::max();
};
static_assert(sizeof(ReaderPage) <= kPageBytes);

}  // namespace hc::internal
