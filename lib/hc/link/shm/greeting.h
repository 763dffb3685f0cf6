// SPDX-License-Identifier: Apache-2.0
#pragma once
// The handshake of a reader and a publisher of shared memory, over a Unix socket: each sends one
// Greeting, the reader with its page and its pipe, the publisher with its memory. Internal.
//
// Nothing else is sent. The publisher wakes the reader with a byte in the pipe. The reader shuts
// down its direction when it takes no more messages, and closes when it holds none.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <hc/base/uri.h>
#include <hc/link/shm/layout.h>

namespace hc::internal {

/// A request to use the publisher's own `keep`.
constexpr std::uint64_t kPublishersKeep = ~std::uint64_t{0};

/// The message of either side. Both are builds of this library on the same machine.
struct Greeting {
  std::array<char, 8> magic;
  /// How many of the newest messages to keep for this reader; 0: all, and the publisher waits. The
  /// reader requests a number or kPublishersKeep; the publisher answers with the actual number.
  std::uint64_t keep;
  std::uint64_t orders;  ///< 1: the reader can call order_everywhere()
  std::uint64_t begin;   ///< from the publisher: position of the first message for this reader
  std::uint64_t bytes;   ///< size of the publisher's memory
  /// From the publisher: why it refuses, in printable characters; empty: it accepts.
  std::array<char, 128> refusal;
};
static_assert(sizeof(Greeting) == 168);

/// The request of a reader.
struct Hello {
  std::uint64_t keep = 0;  ///< how many of the newest messages to keep; 0: all
  bool orders = false;     ///< it can call order_everywhere()
  SharedMemory page;       ///< a ReaderPage
  Descriptor wakes;        ///< its pipe, non-blocking: a byte wakes the reader
};

/// The answer of a publisher.
struct Offer {
  std::uint64_t begin = 0;
  std::uint64_t keep = 0;
  SharedMemory memory;  ///< mapped read-only
};

/// The Unix socket of `shm:NAME`, in the abstract namespace, so that it leaves no file.
Uri meeting_place(const Uri& uri);
/// Checks the length of the name. Errors: Invalid.
Status check_name(const Uri& uri);

/// For the reader: sends its request; never waits. Errors: Closed, System.
Status send_hello(int socket, std::uint64_t keep, const SharedMemory& page, int wakes);

/// The publisher's answer, if it has arrived; never waits.
///
/// Errors: Malformed (not a publisher, or an invalid descriptor), Closed (refused or disconnected).
Result<std::optional<Offer>> take_offer(int socket);

/// Waits for the answer, 4 s at most. Errors: as take_offer(), Stopped, System.
Result<Offer> await_offer(int socket, int stop);

/// For the publisher: a reader's request; never waits.
///
/// @param keep  the publisher's own, 0 if it waits for readers: replaces kPublishersKeep and 0.
/// Errors: Malformed, Closed.
Result<Hello> take_hello(int socket, std::uint64_t keep);

/// Sends the answer with the memory, of `bytes`; never waits. Errors: Closed, System.
Status answer(int socket, const Offer& offer, std::uint64_t bytes, int read_only_memory);
void refuse(int socket, std::string_view why);

}  // namespace hc::internal
