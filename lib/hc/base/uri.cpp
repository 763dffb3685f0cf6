// SPDX-License-Identifier: Apache-2.0
#include <hc/base/uri.h>

#include <algorithm>

#include <hc/base/text.h>

namespace hc {
namespace {

constexpr std::size_t kMaxUriBytes = 4096;

bool is_scheme(std::string_view text) {
  auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  auto is_rest = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-';
  };
  return !text.empty() && is_letter(text.front()) && std::all_of(text.begin(), text.end(), is_rest);
}

Error usage(std::string_view what, std::string_view text) {
  return {Code::Invalid, std::string(what) + ": \"" + std::string(text.substr(0, 80)) + "\""};
}

Status parse_options(std::string_view text, Uri& uri) {
  for (bool is_more = true; is_more;) {
    is_more = text.find('&') != std::string_view::npos;
    const auto pair = take_until(text, '&');
    auto value = pair;
    const std::string key(take_until(value, '='));
    if (key.empty() || key.size() == pair.size())
      return usage("an option of a URI is KEY=VALUE", pair);
    for (const auto& option : uri.options)
      if (option.first == key) return usage("option of a URI given twice", key);
    uri.options.emplace_back(key, value);
  }
  return {};
}

}  // namespace

std::string_view Uri::option(std::string_view key, std::string_view default_value) const {
  for (const auto& [name, value] : options)
    if (name == key) return value;
  return default_value;
}

std::string Uri::text() const {
  std::string text = scheme == "-" ? scheme : scheme + ":" + rest;
  char before = '?';
  for (const auto& [key, value] : options) {
    text.append(1, before).append(key).append("=").append(value);
    before = '&';
  }
  return text;
}

Result<Uri> parse_uri(std::string_view text) {
  if (text.empty()) return usage("a URI cannot be empty", text);
  if (text.size() > kMaxUriBytes)
    return Error{Code::Invalid,
                 "a URI is at most 4096 bytes long, this one has " + std::to_string(text.size())};
  auto is_control = [](char c) { return (c >= 0 && c < 0x20) || c == 0x7f; };
  if (std::any_of(text.begin(), text.end(), is_control))
    return Error{Code::Invalid, "a URI must not contain control characters"};

  auto question = std::min(text.find('?'), text.size());
  std::string_view place = text.substr(0, question);
  auto colon = place.find(':');
  auto path_sign = place.find_first_of("/.");

  Uri uri;
  if (place == "-") {
    uri.scheme = "-";
  } else if (colon == std::string_view::npos || path_sign < colon) {
    uri.scheme = "file";
    uri.rest = place;
  } else {
    uri.scheme = place.substr(0, colon);
    uri.rest = place.substr(colon + 1);
    if (!is_scheme(uri.scheme))
      return usage("a URI's scheme has lower-case letters, digits, + and -", text);
  }
  if (question < text.size()) HC_TRY(parse_options(text.substr(question + 1), uri));
  return uri;
}

Result<std::int64_t> number_option(const Uri& uri, std::string_view key, std::int64_t default_value,
                                   const NumberRange& range) {
  auto digits = uri.option(key, "");
  if (digits.empty()) return default_value;
  int shift = 0;
  if (auto unit = std::string_view("KMG").find(digits.back());
      range.has_units && unit != std::string_view::npos) {
    shift = 10 * (static_cast<int>(unit) + 1);
    digits.remove_suffix(1);
  }
  std::int64_t value = 0;
  if (!read_number(digits, value) || value < range.least || value > range.most >> shift)
    return Error{Code::Invalid, "option " + std::string(key) + " is a whole number from " +
                                    std::to_string(range.least) + " to " +
                                    std::to_string(range.most) +
                                    (range.has_units ? ", also as K, M or G" : "") + ", not \"" +
                                    std::string(uri.option(key, "")) + '"'};
  return value << shift;
}

Result<HostPort> parse_host_port(std::string_view text) {
  HostPort result;
  std::string_view port = text;
  if (text.starts_with('[')) {
    auto close = text.find(']');
    if (close == std::string_view::npos) return usage("no ] after an IPv6 address", text);
    result.host = text.substr(1, close - 1);
    port = text.substr(close + 1);
    if (!port.starts_with(':')) return usage("no :PORT after the address", text);
    port.remove_prefix(1);
  } else if (auto colon = text.rfind(':'); colon != std::string_view::npos) {
    result.host = text.substr(0, colon);
    port = text.substr(colon + 1);
    if (result.host.find(':') != std::string::npos)
      return usage("an IPv6 address is written in brackets", text);
  }
  if (!read_number(port, result.port)) return usage("a port is a number from 0 to 65535", text);
  return result;
}

}  // namespace hc
