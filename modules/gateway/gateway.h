// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a gateway between two graphs does with a message: lets it through or not, gives it the
// numbers and the encoding that it is to have on the other side. Pure.

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

/// Addresses on the other side by those on this one.
using Renumbering = std::map<std::int32_t, std::int32_t>;

/// Reads "12=112 13=113 -2=-5"; empty: every address stays.
///
/// Errors: Invalid (no number; a number on either side twice; an address becomes a group, 0 or -1,
/// or they another).
hc::Result<Renumbering> parse_renumbering(std::string_view text);

/// Reads "12 13 -1".
///
/// Errors: Invalid (no number, or one twice).
hc::Result<std::set<std::int32_t>> parse_addresses(std::string_view text);

/// What may pass, and as what.
struct GatewayRules {
  Renumbering numbers;          ///< of src and dst; those that are not there stay
  std::set<std::int32_t> only;  ///< dst that may pass, by their numbers on this side; empty: all
  std::set<std::int32_t> only_from;  ///< the same of src
};

/// Messages by what became of them.
struct GatewayCounts {
  std::int64_t passed = 0;
  std::int64_t ttl = 0;       ///< dropped: it had no router left to pass (R42)
  std::int64_t unlisted = 0;  ///< dropped: dst or src is not among those that may pass
  std::int64_t no_route = 0;  ///< dropped: no link takes its dst
  std::int64_t damaged = 0;   ///< dropped: its compressed elements cannot be opened

  [[nodiscard]] std::int64_t total() const { return passed + ttl + unlisted + no_route + damaged; }
  /// "3 passed; dropped: 1 ttl, 0 not listed, 0 without a route, 0 damaged"
  [[nodiscard]] std::string text() const;
};

/// Whether a message may pass. Then its ttl is lowered and its numbers are those of the other side;
/// otherwise the reason is counted.
bool admit(hc::Header& header, const GatewayRules& rules, GatewayCounts& counts);

/// The message in another encoding, where it can have it: images of u8 as jpeg, everything plain
/// as zstd when that makes it smaller, everything as text or binary. Otherwise as it is.
///
/// Errors: Malformed (compressed elements that cannot be opened).
hc::Result<hc::Message> in_encoding(const hc::Message& message, hc::Encoding wanted);
