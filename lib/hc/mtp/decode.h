// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages out of bytes that are all in memory; StreamReader is for those that come in pieces.
// Internal. Pure.

#include <cstddef>
#include <cstdint>
#include <span>

#include <hc/base/result.h>
#include <hc/mtp/header_memo.h>
#include <hc/mtp/message.h>

namespace hc::internal {

/// Reads the first message in `bytes`.
///
///     Message message;
///     auto used = decode(bytes, message, limits, 0, memo);
///     if (!used) return used.error();       // refused
///     if (*used == 0) return read_more();   // not complete yet
///
/// @param bytes  start of a stream; less or more than one message.
/// @param[out] message  set when the result is > 0. Its elements view `bytes`, without an owner,
///     where they are in binary form and aligned for their scalar (as u8 always is); others are
///     copied.
/// @param byte  where `bytes` stand in their stream, for errors.
/// @param memo  of the stream's headers.
/// @returns  bytes used; 0 when the message is not complete yet.
///
/// Errors: Malformed, Unsupported, TooLarge; the detail names rule, field and byte.
/// Cost: no allocation for a message that views `bytes`, nor for more numbers than can have come.
Result<std::size_t> decode(std::span<const std::byte> bytes, Message& message, const Limits& limits,
                           std::uint64_t byte, HeaderMemo& memo);

}  // namespace hc::internal
