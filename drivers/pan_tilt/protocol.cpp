// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/protocol.h>

#include <cmath>

#include <hc/base/text.h>

namespace hc::pan_tilt {
namespace {

bool is_line_end(char byte) {
  return byte == '\r' || byte == '\n';
}
bool is_printable(char byte) {
  return byte >= ' ' && byte <= '~';
}

/// The text after the mark and its spaces.
std::string text_of(std::string_view line) {
  const auto first = line.find_first_not_of(' ', 1);
  if (first == std::string_view::npos) return {};
  return std::string(line.substr(first, line.find_last_not_of(' ') + 1 - first));
}

}  // namespace

std::string command(std::string_view name, std::optional<std::int32_t> value) {
  std::string bytes(name);
  if (value) bytes += std::to_string(*value);
  return bytes + ' ';
}

void ReplyReader::feed(std::string_view bytes) {
  bytes_.erase(0, position_);
  position_ = 0;
  bytes_ += bytes;
}

std::optional<Result<Reply>> ReplyReader::refuse(Error error) {
  line_.clear();
  skips_ = true;
  return error;
}

std::optional<Result<Reply>> ReplyReader::next() {
  while (position_ < bytes_.size()) {
    const char byte = bytes_[position_++];
    if (is_line_end(byte)) {
      skips_ = false;
      if (line_.empty()) continue;
      std::string text = text_of(line_);
      const bool is_refusal = line_[0] == '!';
      line_.clear();
      const auto kind = is_refusal     ? Reply::Kind::Refused
                        : text.empty() ? Reply::Kind::Done
                                       : Reply::Kind::Result;
      return Reply{kind, std::move(text)};
    }
    if (skips_ || (line_.empty() && byte == ' ')) continue;
    if (!is_printable(byte) || (line_.empty() && byte != '*' && byte != '!'))
      return refuse(
          {Code::Malformed, "garbage: 0x" + hexadecimal_byte(byte) +
                                (line_.empty() ? " does not start a reply" : " in a reply")});
    // Limit reports have no line end: "!T!T!P!P*".
    if (line_ == "!" && (byte == 'P' || byte == 'T')) {
      line_.clear();
      return Reply{byte == 'P' ? Reply::Kind::PanLimit : Reply::Kind::TiltLimit, {}};
    }
    line_ += byte;
    if (line_.size() > kMaxReplyBytes)
      return refuse({Code::TooLarge,
                     "garbage: a reply of more than " + std::to_string(kMaxReplyBytes) + " bytes"});
  }
  return std::nullopt;
}

Result<double> number(std::string_view text) {
  double value = 0;
  if (!read_number(text, value) || !std::isfinite(value))
    return Error{Code::Malformed, "garbage: \"" + std::string(text) + "\" is not a number"};
  return value;
}

}  // namespace hc::pan_tilt
