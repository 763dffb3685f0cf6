// SPDX-License-Identifier: Apache-2.0
#include "json.h"

#include <cmath>

#include <hc/base/json_string.h>
#include <hc/mtp/matrix_view.h>

#include "readable.h"

namespace tool {
namespace {

template <typename T>
void append_json_number(T value, std::string& json) {
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) {
      json += '"';
      append_number(value, json);
      json += '"';
      return;
    }
  }
  append_number(value, json);
}

constexpr std::size_t kPiece = 64 << 10;  // [byte]

using Write = std::function<bool(std::string_view)>;

/// Writes the text once it is long enough; false to stop.
bool flush(std::string& json, const Write& write) {
  if (json.size() < kPiece) return true;
  const bool is_taken = write(json);
  json.clear();
  return is_taken;
}

template <typename T>
bool write_matrix(const hc::MatrixView<const T>& matrix, std::string& json, const Write& write) {
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
      if (!flush(json, write)) return false;
    }
    json += ']';
  }
  json += ']';
  return true;
}

bool write_rows_of_text(const hc::Message& message, std::string& json, const Write& write) {
  json += '[';
  if (!message.header.empty()) {
    auto width = static_cast<std::size_t>(message.header.width);
    for (std::size_t at = 0; at < message.elements.size(); at += width) {
      if (at > 0) json += ',';
      hc::append_json_string(message.text().substr(at, width), json);
      if (!flush(json, write)) return false;
    }
  }
  json += ']';
  return true;
}

}  // namespace

bool write_json(const hc::Message& message, const hc::Header& header, const Write& write) {
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
  add("time", hc::unix_nanoseconds(header.time));
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
  bool is_taken = true;
  if (!message.plain())
    json += "null";
  else if (header.info.type == hc::MatrixType::String)
    is_taken = write_rows_of_text(message, json, write);
  else
    hc::visit_scalar(header.info.scalar, [&](auto zero) {
      is_taken = write_matrix(*hc::view<decltype(zero)>(message), json, write);
    });
  return is_taken && write(json + "}\n");
}

}  // namespace tool
