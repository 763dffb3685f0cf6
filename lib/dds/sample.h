// SPDX-License-Identifier: Apache-2.0
#pragma once
// Samples of Cyclone DDS that are messages: struct Message { sequence<octet> bytes; }, one or more
// whole messages each, header line and elements. Internal.

#include <cstdint>
#include <functional>
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

/// What a sample has beside its messages: encapsulation, number of bytes, padding. [byte]
inline constexpr std::uint64_t kFrame = 12;

struct LetGo {
  void operator()(ddsi_serdata* sample) const { ddsi_serdata_unref(sample); }
};
using Sample = std::unique_ptr<ddsi_serdata, LetGo>;

/// The type of our topics.
ddsi_sertype* make_type();

/// Elements up to this size are copied into their sample: a piece more costs as much. [byte]
inline constexpr std::size_t kMostCopied = 4096;

/// A sample of a message, whose elements stay where they are, with an owner, or are copied.
/// @param pieces  of `message`.
Sample make_sample(const ddsi_sertype& type, const Pieces& pieces, const Message& message);

/// A sample of several messages has at most so many bytes, whatever the largest message is. [byte]
inline constexpr std::size_t kMostJoined = 16 << 10;

/// Adds a message to a sample that is not sent yet; false if elements of either are not copied, or
/// the sample would be larger than kMostJoined.
bool join(ddsi_serdata& sample, const Pieces& pieces);

/// A sample without octets: its writer has closed, and nothing more will come of it.
Sample make_end(const ddsi_sertype& type);

/// How many octets a sample has that has come, and perhaps some of padding; 0: its writer has
/// closed.
std::uint64_t octets_of(const ddsi_serdata& sample);

/// Reads the messages out of a sample that has come, and calls `take` with each and its size [byte]
/// until one is wrong. A message that is alone and not rows of numbers is not copied again; what is
/// held of several does not keep the others.
///
/// Errors: Malformed (no sequence of octets, or no message), Truncated, Unsupported, TooLarge (a
/// message, or more than 10,000 of them).
Status read_messages(const ddsi_serdata& sample, const Limits& limits, internal::HeaderMemo& memo,
                     const std::function<void(Message, std::uint64_t)>& take);

}  // namespace hc::dds
