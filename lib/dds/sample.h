// SPDX-License-Identifier: Apache-2.0
#pragma once
// Samples of type struct Message { sequence<octet> bytes; }, which hold one or more complete
// messages, header lines and elements. Internal.

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

/// Overhead of a sample: encapsulation header, sequence length, padding. [byte]
inline constexpr std::uint64_t kFrame = 12;

struct Unref {
  void operator()(ddsi_serdata* sample) const { ddsi_serdata_unref(sample); }
};
using Sample = std::unique_ptr<ddsi_serdata, Unref>;

/// The type of the topics.
ddsi_sertype* make_type();

/// Elements up to this size are copied into the sample, which costs no more than another fragment.
/// [byte]
inline constexpr std::size_t kMaxCopied = 4096;

/// A sample of one message. Its elements are shared, or copied if they are small or have no owner.
/// @param pieces  of `message`.
Sample make_sample(const ddsi_sertype& type, const Pieces& pieces, const Message& message);

/// Maximum size of a sample of several messages. [byte]
inline constexpr std::size_t kMaxJoined = 16 << 10;

/// Adds a message to a sample that has not been sent; false if the elements of either are not
/// copied, or the sample would exceed kMaxJoined.
bool join(ddsi_serdata& sample, const Pieces& pieces);

/// A sample without octets, which marks the end of a writer's messages.
Sample make_end(const ddsi_sertype& type);

/// The number of octets of a received sample, possibly with padding; 0: its writer has closed.
std::uint64_t octets_of(const ddsi_serdata& sample);

/// Parses a received sample and calls `take` with each message and its size [byte], up to the first
/// invalid one. A single message is not copied, unless it is rows of numbers; of several small
/// messages, each can be stored without the others' memory.
///
/// Errors: Malformed (not a sequence of octets, or not a message), Truncated, Unsupported, TooLarge
/// (a message, or more than 10,000 messages).
Status read_messages(const ddsi_serdata& sample, const Limits& limits, internal::HeaderMemo& memo,
                     const std::function<void(Message, std::uint64_t)>& take);

}  // namespace hc::dds
