// SPDX-License-Identifier: Apache-2.0
#include "gateway.h"

#include <hc/base/text.h>
#include <hc/base/words.h>
#include <hc/compress/compress.h>

namespace {

hc::Error usage(std::string_view word, const char* what) {
  return {hc::Code::Invalid, "\"" + std::string(word) + "\" " + what};
}

}  // namespace

hc::Result<Renumbering> parse_renumbering(std::string_view text) {
  Renumbering numbers;
  std::set<std::int32_t> taken;
  for (auto word : hc::words_of(text)) {
    auto equals = word.find('=');
    std::int32_t here = 0, there = 0;
    if (equals == std::string_view::npos || !hc::read_number(word.substr(0, equals), here) ||
        !hc::read_number(word.substr(equals + 1), there))
      return usage(word, "is not NUMBER=NUMBER");
    bool are_addresses = here > 0 && there > 0, are_groups = here < -1 && there < -1;
    if (!are_addresses && !are_groups)
      return usage(word, "must map an address to an address, or a group to a group");
    if (!numbers.emplace(here, there).second || !taken.insert(there).second)
      return usage(word, "repeats a number");
  }
  return numbers;
}

hc::Result<std::set<std::int32_t>> parse_addresses(std::string_view text) {
  std::set<std::int32_t> addresses;
  for (auto word : hc::words_of(text)) {
    std::int32_t number = 0;
    if (!hc::read_number(word, number)) return usage(word, "is not an address");
    if (!addresses.insert(number).second) return usage(word, "is repeated");
  }
  return addresses;
}

std::string GatewayCounts::text() const {
  return std::to_string(passed) + " passed; dropped: " + std::to_string(ttl) + " ttl, " +
         std::to_string(unlisted) + " not listed, " + std::to_string(no_route) +
         " without a route, " + std::to_string(damaged) + " damaged";
}

bool admit(hc::Header& header, const GatewayRules& rules, GatewayCounts& counts) {
  auto is_listed = [](const std::set<std::int32_t>& list, std::int32_t number) {
    return list.empty() || list.contains(number);
  };
  if (!is_listed(rules.only, header.dst) || !is_listed(rules.only_from, header.src)) {
    ++counts.unlisted;
    return false;
  }
  if (header.ttl <= 1) {
    ++counts.ttl;
    return false;
  }
  --header.ttl;
  for (std::int32_t* number : {&header.src, &header.dst})
    if (auto found = rules.numbers.find(*number); found != rules.numbers.end())
      *number = found->second;
  return true;
}

hc::Result<hc::Message> in_encoding(const hc::Message& message, hc::Encoding wanted) {
  hc::Info info = message.header.info;
  info.encoding = wanted;
  if (message.header.empty() || hc::broken_rule(info) != 0) return message;
  if (wanted == hc::Encoding::Text || wanted == hc::Encoding::Binary) {
    auto plain = hc::expand(message);
    if (plain) plain->header.info.encoding = wanted;  // text and binary are the same in memory
    return plain;
  }
  if (!message.plain()) return message;
  auto small = hc::compress(message, wanted);
  if (!small || small->elements.size() >= message.elements.size()) return message;
  return small;
}
