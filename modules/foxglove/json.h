// SPDX-License-Identifier: Apache-2.0
#pragma once
// JSON for viewers.

#include <string>

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

/// One line of JSON. Invalid UTF-8 is replaced; never throws.
inline std::string text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The beginning of a value, to quote in an error.
inline std::string excerpt(const Json& json) {
  constexpr std::size_t kMaxExcerpt = 100;
  return text(json).substr(0, kMaxExcerpt);
}

/// The string of a key; empty if missing.
inline std::string string_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}
