// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/framing.h>

#include <algorithm>
#include <charconv>

#include <hc/mtp/refusal.h>

namespace hc::internal {

Result<HeaderLine> read_header_line(std::string_view text, const Limits& limits, std::uint64_t byte,
                                    HeaderMemo& memo) {
  auto line = text.substr(0, std::min(text.size(), kMaxHeaderBytes));
  auto end = line.find('\n');
  if (end == std::string_view::npos) {
    if (line.size() < kMaxHeaderBytes) return HeaderLine{};
    return refusal(Code::Malformed, 3, "header", "no line feed within 256 bytes",
                   byte + kMaxHeaderBytes);
  }
  line = line.substr(0, end);
  if (line.ends_with('\r')) line.remove_suffix(1);
  auto header = memo.parse(line, limits, byte);
  if (!header) return header.error();
  return HeaderLine{*header, end + 1};
}

Result<LengthLine> read_length_line(std::string_view text, const Limits& limits,
                                    std::uint64_t byte) {
  constexpr std::size_t kMaxLengthLine = 20;  // R34: bytes before the line feed
  auto line = text.substr(0, std::min(text.size(), kMaxLengthLine + 1));
  auto end = line.find('\n');
  if (end == std::string_view::npos && line.size() <= kMaxLengthLine) return LengthLine{};
  auto token = line.substr(0, std::min(end, line.size()));
  LengthLine result;
  const char* last = token.data() + token.size();
  auto [stop, status] = std::from_chars(token.data(), last, result.length);
  bool too_long = end == std::string_view::npos;
  bool spelled = !token.empty() && stop == last && (token.front() != '0' || token.size() == 1);
  if (too_long || !spelled)
    return refusal(Code::Malformed, 34, "length", in_quotes(token) + " is not a number of bytes",
                   byte);
  if (status != std::errc() || result.length > limits.element_bytes)
    return refusal(
        Code::TooLarge, 35, "length",
        std::string(token) + " bytes exceed the limit of " + std::to_string(limits.element_bytes),
        byte);
  result.bytes = end + 1;
  return result;
}

Result<std::size_t> read_closing(const Header& header, std::string_view text, std::uint64_t byte) {
  if (text.empty()) return std::size_t{0};
  if (text.front() == '\n') return std::size_t{1};
  if (header.info.encoding == Encoding::Text && text.front() == '\r') {
    if (text.size() == 1) return std::size_t{0};
    if (text[1] == '\n') return std::size_t{2};
  }
  return refusal(Code::Malformed, 26, "elements",
                 in_quotes(text.substr(0, 1)) + " follows the elements instead of a line feed",
                 byte);
}

}  // namespace hc::internal
