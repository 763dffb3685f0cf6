// SPDX-License-Identifier: Apache-2.0
#include "json.h"

#include <cmath>

#include <hc/wire/text.h>

namespace tool {
namespace {

/// Bytes of the well-formed UTF-8 character at the start of `text`; 0 when there is none.
/// Source: The Unicode Standard, table 3-7.
std::size_t utf8_length(std::string_view text) {
  auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  auto is_tail = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return is_tail(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f);
    return !wrong && is_tail(1) && is_tail(2) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    bool wrong = (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return !wrong && is_tail(1) && is_tail(2) && is_tail(3) ? 4 : 0;
  }
  return 0;
}

void append_string(std::string_view text, std::string& json) {
  constexpr std::string_view kHex = "0123456789abcdef";
  json += '"';
  while (!text.empty()) {
    std::size_t length = utf8_length(text);
    char c = text.front();
    if (length == 0) {
      json += "\xef\xbf\xbd";  // U+FFFD
      length = 1;
    } else if (c == '"' || c == '\\') {
      json += '\\';
      json += c;
    } else if (c == '\n') {
      json += "\\n";
    } else if (c == '\r') {
      json += "\\r";
    } else if (c == '\t') {
      json += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      json += "\\u00";
      json += kHex[static_cast<unsigned char>(c) >> 4];
      json += kHex[static_cast<unsigned char>(c) & 15];
    } else {
      json += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  json += '"';
}

template <typename T>
void append_json_number(T value, std::string& json) {
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) {
      json += '"';
      hc::append_number(value, json);
      json += '"';
      return;
    }
  }
  hc::append_number(value, json);
}

template <typename T>
void append_matrix(const hc::MatrixView<const T>& matrix, std::string& json) {
  json += '[';
  for (std::size_t y = 0; y < (matrix.empty() ? 0 : matrix.height()); ++y) {
    json += y == 0 ? "[" : ",[";
    auto row = matrix.row(y);
    std::size_t components = matrix.components();
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) json += ',';
      if (components > 1 && i % components == 0) json += '[';
      append_json_number(row[i], json);
      if (components > 1 && i % components == components - 1) json += ']';
    }
    json += ']';
  }
  json += ']';
}

void append_rows_of_text(const hc::Message& message, std::string& json) {
  json += '[';
  if (!message.header.empty()) {
    auto width = static_cast<std::size_t>(message.header.width);
    for (std::size_t at = 0; at < message.elements.size(); at += width) {
      if (at > 0) json += ',';
      append_string(message.characters().substr(at, width), json);
    }
  }
  json += ']';
}

}  // namespace

std::string to_json(const hc::Message& message) {
  return to_json_as(message, message.header);
}

std::string to_json_as(const hc::Message& message, const hc::Header& header) {
  std::string json = "{\"version\":1";
  auto add = [&](std::string_view key, std::int64_t value) {
    json.append(",\"").append(key).append("\":").append(std::to_string(value));
  };
  auto add_name = [&](std::string_view key, std::string_view value) {
    json.append(",\"").append(key).append("\":\"").append(value).append("\"");
  };
  add("src", header.src);
  add("dst", header.dst);
  add("seq", header.seq);
  add("ttl", header.ttl);
  add("time", header.time);
  add("info", header.info.code());
  add("mode", header.mode);
  add("coord", header.coord);
  add("width", header.width);
  add("height", header.height);
  add_name("type", name(header.info.type));
  add("components", header.info.components);
  add_name("scalar", name(header.info.scalar));
  add_name("encoding", name(header.info.encoding));
  json += ",\"elements\":";
  if (!message.plain()) {
    json += "null";
  } else if (header.info.type == hc::MatrixType::String) {
    append_rows_of_text(message, json);
  } else {
    hc::visit_scalar(header.info.scalar,
                     [&](auto zero) { append_matrix(*message.view<decltype(zero)>(), json); });
  }
  return json + "}";
}

}  // namespace tool
