// SPDX-License-Identifier: Apache-2.0
#pragma once
// A gateway between two graphs: filters messages, and converts their addresses and encoding for the
// other graph. Pure.

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

/// Addresses in the other graph, by those in this graph.
using Renumbering = std::map<std::int32_t, std::int32_t>;

/// Reads "12=112 13=113 -2=-5"; empty: addresses are unchanged.
///
/// Errors: Invalid (not a number; a number repeated on one side; a map between addresses and
/// groups, or of 0 or -1).
hc::Result<Renumbering> parse_renumbering(std::string_view text);

/// Reads "12 13 -1". Errors: Invalid (not a number, or repeated).
hc::Result<std::set<std::int32_t>> parse_addresses(std::string_view text);

/// Which messages pass, and their new addresses.
struct GatewayRules {
  Renumbering numbers;               ///< of src and dst; others are unchanged
  std::set<std::int32_t> only;       ///< dst that pass, as in this graph; empty: all
  std::set<std::int32_t> only_from;  ///< src that pass, as in this graph; empty: all
};

/// Messages passed and dropped.
struct GatewayCounts {
  std::int64_t passed = 0;
  std::int64_t ttl = 0;       ///< dropped: ttl used up (R42)
  std::int64_t unlisted = 0;  ///< dropped: dst or src not listed
  std::int64_t no_route = 0;  ///< dropped: no link for its dst
  std::int64_t damaged = 0;   ///< dropped: its elements cannot be decompressed

  [[nodiscard]] std::int64_t total() const { return passed + ttl + unlisted + no_route + damaged; }
  /// "3 passed; dropped: 1 ttl, 0 not listed, 0 without a route, 0 damaged"
  [[nodiscard]] std::string text() const;
};

/// Whether a message passes. If so, decrements its ttl and converts its addresses; otherwise counts
/// the reason.
bool admit(hc::Header& header, const GatewayRules& rules, GatewayCounts& counts);

/// Converts the encoding where possible: u8 images to jpeg, plain messages to zstd if that is
/// smaller, all messages to text or binary. Otherwise returns the message unchanged.
///
/// Errors: Malformed (elements that cannot be decompressed).
hc::Result<hc::Message> in_encoding(const hc::Message& message, hc::Encoding wanted);
