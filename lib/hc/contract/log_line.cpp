// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/log_line.h>

#include <array>

#include <nlohmann/json.hpp>

#include <hc/base/text.h>
#include <hc/mtp/rows.h>

namespace hc {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"info", "warning", "error", "result", "notice"};

}  // namespace

std::string_view name(Level level) {
  return kNames.at(static_cast<std::size_t>(level));
}

std::optional<Level> level_named(std::string_view name) {
  return enum_named<Level>(kNames, name);
}

std::string LogLine::line() const {
  return module + ": " + (level == Level::Error ? "error: " : "") + text;
}

Message make_log(Level level, std::string_view text) {
  return make_rows(std::array{std::string(name(level)) + " " + std::string(text)});
}

Result<LogLine> read_log(const Message& message) {
  const auto rows = rows_of(message);
  const std::string row = rows.empty() ? "" : rows.front();
  std::string_view said = row;
  const auto level = level_named(take_until(said, ' '));
  if (!level) return Error{Code::Malformed, "not a log report, LEVEL TEXT: \"" + row + "\""};
  return LogLine{{}, *level, std::string(said)};
}

std::string to_json(const LogLine& line) {
  const nlohmann::ordered_json json = {
      {"module", line.module}, {"level", name(line.level)}, {"text", line.text}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<LogLine> parse_log_line(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const Error wrong{Code::Malformed, "a line of a graph's log has module, level and text"};
  if (!json.is_object()) return wrong;
  auto word = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? std::optional(found->get<std::string>())
                                                     : std::nullopt;
  };
  const auto module = word("module"), level = word("level"), said = word("text");
  const auto known = level ? level_named(*level) : std::nullopt;
  if (!module || !known || !said) return wrong;
  return LogLine{*module, *known, *said};
}

}  // namespace hc
