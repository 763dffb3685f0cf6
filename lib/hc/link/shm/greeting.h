// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a reader and a publisher of shared memory meet, over a Unix socket: each sends a Greeting,
// once. The reader's comes with its page and its pipe, the publisher's with its memory. Internal.
//
// From then on nothing is sent. To wake a reader, the publisher writes a byte to its pipe. The
// reader ends its own direction when it takes no more, and the connection when it holds no more.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <hc/base/uri.h>
#include <hc/link/shm/layout.h>

namespace hc::internal {

/// A reader that asks for this keeps what the publisher says.
constexpr std::uint64_t kPublishersKeep = ~std::uint64_t{0};

/// What either side says. Both are builds of this library on one machine.
struct Greeting {
  std::array<char, 8> magic;
  /// Newest messages that wait for this reader at most; 0: all, the publisher waits. The reader
  /// asks, perhaps for kPublishersKeep; the publisher answers what it is.
  std::uint64_t keep;
  std::uint64_t orders;  ///< 1: the reader can order_everywhere()
  std::uint64_t begin;   ///< of the publisher: position of the first message for this reader
  std::uint64_t bytes;   ///< of the publisher's memory
  std::array<char, 128>
      refusal;  ///< of the publisher: why it refuses, printable; empty: it does not
};
static_assert(sizeof(Greeting) == 168);

/// What a reader asks for, and hands over.
struct Hello {
  std::uint64_t keep = 0;  ///< newest messages that wait for it at most; 0: all of them
  bool orders = false;     ///< it can order the stores of both sides
  SharedMemory page;       ///< a ReaderPage
  Descriptor wakes;        ///< its pipe, open to be written to without waiting: a byte wakes it
};

/// What a publisher offers.
struct Offer {
  std::uint64_t begin = 0;
  std::uint64_t keep = 0;
  SharedMemory memory;  ///< as the reader maps it
};

/// The Unix socket where `shm:NAME` is met: abstract, so that nothing is left of it.
Uri meeting_place(const Uri& uri);
/// Whether the name is one. Errors: Invalid.
Status check_name(const Uri& uri);

/// The reader's side: says what it wants; never waits. Errors: Closed, System.
Status send_hello(int socket, std::uint64_t keep, const SharedMemory& page, int wakes);

/// What the publisher has answered; never waits, and gives nothing when there is no answer yet.
///
/// Errors: Malformed (no such peer, or what it hands over is not as it should be), Closed (it has
/// refused or disconnected).
Result<std::optional<Offer>> take_offer(int socket);

/// Waits for the answer, 4 s at most. Errors: as take_offer(), Stopped, System.
Result<Offer> await_offer(int socket, int stop);

/// The publisher's side: what a reader has said; never waits.
///
/// @param keep  of a reader that leaves it to the publisher, or asks for all: a publisher that
/// waits
///     for none says so here, and 0 where it waits.
/// Errors: Malformed, Closed.
Result<Hello> take_hello(int socket, std::uint64_t keep);

/// Hands the memory over, of `bytes`, with what else the offer says; never waits. Errors: Closed,
/// System.
Status answer(int socket, const Offer& offer, std::uint64_t bytes, int read_only_memory);
void refuse(int socket, std::string_view why);

}  // namespace hc::internal
