// SPDX-License-Identifier: Apache-2.0
#pragma once
// Samples of Cyclone DDS that are messages: struct Message { sequence<octet> bytes; }, one whole
// message each, header line and elements. Internal.

#include <cstdint>
#include <memory>
#include <span>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <hc/mtp/codec.h>
#include <hc/mtp/header_memo.h>
#include <hc/mtp/message.h>

namespace hc::dds {

inline constexpr const char* kTypeName = "hypercolumn::Message";

/// What a sample has beside its message: encapsulation, number of bytes, padding. [byte]
inline constexpr std::uint64_t kFrame = 12;

struct LetGo {
  void operator()(ddsi_serdata* sample) const { ddsi_serdata_unref(sample); }
};
using Sample = std::unique_ptr<ddsi_serdata, LetGo>;

/// The type of our topics.
ddsi_sertype* make_type();

/// A sample of a message, whose elements stay where they are, with an owner, or are copied.
/// @param pieces  of `message`.
Sample make_sample(const ddsi_sertype& type, const Pieces& pieces, const Message& message);

/// A sample without octets: its writer has closed, and nothing more will come of it.
Sample make_end(const ddsi_sertype& type);

/// How many octets a sample has that has come, and perhaps some of padding; 0: its writer has
/// closed.
std::uint64_t octets_of(const ddsi_serdata& sample);

/// Reads the message out of a sample that has come, without another copy unless its elements are
/// rows of numbers.
///
/// Errors: Malformed (no sequence of octets, or no message, or more than one), Truncated,
/// Unsupported, TooLarge.
Result<Message> read_message(const ddsi_serdata& sample, const Limits& limits,
                             internal::HeaderMemo& memo);

}  // namespace hc::dds
