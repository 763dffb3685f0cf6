// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a reader and a publisher of shared memory meet, over a Unix socket: each says one line of
// text and hands over its memory. Internal.
//
//   reader:     MTP-SHM/1 keep=all orders=1                with its page
//   publisher:  MTP-SHM/1 bytes=N begin=P keep=K           with its memory, or
//               MTP-SHM/1 refused: WHY
//
// The reader leaves keep out to have what the publisher has chosen. orders=1: it can order stores
// everywhere, and will where the publisher relies on that (Head::unfenced).
//
// From then on the publisher says a byte when the reader has asked to be woken so; the reader ends
// its own direction when it takes no more, and the connection when it holds no more.

#include <optional>
#include <string>
#include <string_view>

#include <hc/base/uri.h>
#include <hc/link/shm/layout.h>

namespace hc::internal {

/// What a reader asks for.
struct Hello {
  std::uint64_t keep = 0;  ///< newest messages that wait for it; 0: all, the publisher waits
  bool orders = false;     ///< it can order_everywhere()
  SharedMemory page;
};

/// What a publisher offers.
struct Offer {
  std::uint64_t begin = 0;  ///< position of the first message for this reader
  std::uint64_t keep = 0;   ///< what is kept for it, as in Hello
  SharedMemory memory;      ///< as the reader maps it
};

/// The Unix socket where `shm:NAME` is met: abstract, so that nothing is left of it.
Uri meeting_place(const Uri& uri);
/// Whether the name is one. Errors: Invalid.
Status check_name(const Uri& uri);

/// The reader's side: says what it wants; never waits.
///
/// @param keep  nothing: as the publisher wants it.
/// Errors: Closed, System.
Status send_hello(int socket, std::string_view keep, const SharedMemory& page);

/// What the publisher has answered; never waits, and gives nothing when there is no answer yet.
///
/// Errors: Malformed (no such peer, or what it hands over is not as it should be), Closed (it has
/// refused or gone).
Result<std::optional<Offer>> take_offer(int socket);

/// Waits for the answer, 4 s at most. Errors: as take_offer(), Stopped, System.
Result<Offer> await_offer(int socket, int stop);

/// The publisher's side: what a reader has said; never waits.
///
/// @param otherwise  what is kept for one who does not say, or who asks for all: a publisher that
///     waits for none says so here, and 0 where it waits.
/// Errors: Malformed, Closed.
Result<Hello> take_hello(int socket, std::uint64_t default_value);

/// Hands the memory over, of `bytes`, with what else the offer says; never waits. Errors: Closed,
/// System.
Status answer(int socket, const Offer& offer, std::uint64_t bytes, int read_only_memory);
void refuse(int socket, std::string_view why);

/// How many messages wait: "all", which is 0, "latest" or a number from 1 on. Errors: Invalid.
Result<std::uint64_t> parse_keep(std::string_view text);

}  // namespace hc::internal
