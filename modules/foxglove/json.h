// SPDX-License-Identifier: Apache-2.0
#pragma once
// What is said to viewers, as text.

#include <string>

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

/// One line. What is no UTF-8, of a log or cut in the middle, is replaced; nothing throws.
inline std::string text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The beginning of a value, to be quoted in an error.
inline std::string excerpt(const Json& json) {
  constexpr std::size_t kMaxExcerpt = 100;
  return text(json).substr(0, kMaxExcerpt);
}

/// The text of a key; empty where there is none.
inline std::string string_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}
