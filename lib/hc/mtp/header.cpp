// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/header.h>

#include <array>
#include <limits>
#include <optional>

#include <hc/mtp/digits.h>
#include <hc/mtp/refusal.h>

namespace hc {
namespace {

using internal::in_quotes;
using internal::Outcome;
using internal::refusal;

enum Field : std::size_t {
  Version,
  Src,
  Dst,
  Seq,
  Ttl,
  Time,
  InfoCode,
  Mode,
  Coord,
  Width,
  Height
};
constexpr std::size_t kFields = Height + 1;

struct FieldRule {
  std::string_view name;
  std::int64_t least, most;
};

constexpr std::int64_t kMax31 = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kMax63 = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kMaxTtl = 255;
constexpr int kFirstRule = 6;  // field i is ruled by R(6 + i)
constexpr std::int64_t kMaxJpegSide = 65500;

constexpr std::array<FieldRule, kFields> kRules = {{
    {"version", kVersion, kVersion},
    {"src", 0, kMax31},
    {"dst", std::numeric_limits<std::int32_t>::min(), kMax31},
    {"seq", 0, kMax63},
    {"ttl", 0, kMaxTtl},
    {"time", 0, kMax63},
    {"info", 0, kMax31},
    {"mode", 0, kMax31},
    {"coord", 0, kMax31},
    {"width", 0, kMax31},
    {"height", 0, kMax31},
}};

using Fields = std::array<std::int64_t, kFields>;

/// A rule that a header breaks, found in one of its fields.
struct Finding {
  Code code = Code::Malformed;
  int rule = 0;
  std::size_t field = 0;
  std::string what;
};

bool is_in_range(std::size_t field, std::int64_t value) {
  return value >= kRules[field].least && value <= kRules[field].most;
}

std::optional<Finding> find_range_error(std::size_t field, std::int64_t value) {
  const FieldRule& rule = kRules[field];
  if (is_in_range(field, value)) return std::nullopt;
  if (field == Version)
    return Finding{Code::Unsupported, kFirstRule, field,
                   "this reader knows version 1, not " + std::to_string(value)};
  bool below = value < rule.least;
  return Finding{Code::Malformed, kFirstRule + static_cast<int>(field), field,
                 std::to_string(value) + (below ? " is below " : " is above ") +
                     std::to_string(below ? rule.least : rule.most)};
}

/// The rules that a width or height breaks with its info (R21 … R23).
std::optional<Finding> find_shape_error(std::size_t field, std::int64_t width, std::int64_t height,
                                        const Info& info) {
  std::int64_t side = field == Width ? width : height;
  if (info.encoding == Encoding::Jpeg && (side < 1 || side > kMaxJpegSide))
    return Finding{Code::Malformed, 21, field,
                   "the side of a JPEG image is 1 to 65500, not " + std::to_string(side)};
  if (field == Width && info.type == MatrixType::SparseGraph && side != 1)
    return Finding{Code::Malformed, 22, field,
                   "a sparse graph has width 1, not " + std::to_string(side)};
  if (field == Height && info.type == MatrixType::DenseGraph && side != width)
    return Finding{
        Code::Malformed, 23, field,
        "a dense graph is square, not " + std::to_string(width) + " x " + std::to_string(height)};
  return std::nullopt;
}

bool has_good_size(const Header& header, const Limits& limits) {
  // Both sides are below 2³¹ and an element has at most 792 bytes: the product of the sides fits
  // into 64 bits, and so does that of all three when the first is below 2⁵⁴.
  std::uint64_t elements =
      static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height);
  return elements >> 54 == 0 && elements * header.info.element_bytes() <= limits.element_bytes;
}

std::optional<Finding> find_size_error(const Header& header, const Limits& limits) {
  if (has_good_size(header, limits)) return std::nullopt;
  return Finding{Code::TooLarge, 24, Width,
                 std::to_string(header.width) + " x " + std::to_string(header.height) + " x " +
                     std::to_string(header.info.element_bytes()) + " bytes are over the limit of " +
                     std::to_string(limits.element_bytes)};
}

Header header_of(const Fields& values, const Info& info) {
  Header header;
  header.src = static_cast<std::int32_t>(values[Src]);
  header.dst = static_cast<std::int32_t>(values[Dst]);
  header.seq = values[Seq];
  header.ttl = static_cast<std::uint8_t>(values[Ttl]);
  header.time = values[Time];
  header.info = info;
  header.mode = static_cast<std::int32_t>(values[Mode]);
  header.coord = static_cast<std::int32_t>(values[Coord]);
  header.width = static_cast<std::int32_t>(values[Width]);
  header.height = static_cast<std::int32_t>(values[Height]);
  return header;
}

/// Whether a header's sides have rules of their own (R21 … R23).
bool has_shape_rule(const Info& info) {
  return info.encoding == Encoding::Jpeg || info.type == MatrixType::DenseGraph ||
         info.type == MatrixType::SparseGraph;
}

}  // namespace

Result<Header> parse_header(std::string_view line, const Limits& limits, std::uint64_t byte) {
  Fields values{};
  std::array<std::size_t, kFields> begins{};
  Info info;
  std::size_t at = 0;
  auto skip_spaces = [&] {
    while (at < line.size() && line[at] == ' ') ++at;
  };
  auto refuse = [&](const Finding& finding) {
    return refusal(finding.code, finding.rule, kRules[finding.field].name, finding.what,
                   byte + begins[finding.field]);
  };
  for (std::size_t field = 0; field < kFields; ++field) {
    skip_spaces();
    begins[field] = at;
    if (at == line.size())
      return refuse({Code::Malformed, 4, field,
                     "missing; a header has 11 fields, this one " + std::to_string(field)});
    const char *const end = line.data() + line.size(), *next = nullptr;
    auto outcome = internal::read_integer(line.data() + at, end, values[field], next);
    if (next != end && *next != ' ') outcome = Outcome::NotANumber;
    if (outcome != Outcome::Good) [[unlikely]] {
      const auto token = in_quotes(line.substr(at, line.find(' ', at) - at));
      if (outcome == Outcome::NotANumber)
        return refuse({Code::Malformed, 5, field, token + " is not an integer"});
      return refuse({field == Version ? Code::Unsupported : Code::Malformed,
                     kFirstRule + static_cast<int>(field), field, token + " is out of range"});
    }
    at = static_cast<std::size_t>(next - line.data());
    if (!is_in_range(field, values[field])) [[unlikely]]
      return refuse(*find_range_error(field, values[field]));
    if (field == InfoCode) {
      auto parsed = parse_info(values[field]);
      if (!parsed) {  // "R18: what" becomes "R18 info: what, at byte 12"
        const std::string& detail = parsed.error().detail;
        int rule = (detail[1] - '0') * 10 + (detail[2] - '0');
        return refuse({parsed.error().code, rule, field, detail.substr(5)});
      }
      info = *parsed;
    }
    if ((field == Width || field == Height) && has_shape_rule(info))
      if (auto error = find_shape_error(field, values[Width], values[Height], info))
        return refuse(*error);
  }
  skip_spaces();
  if (at < line.size())
    return refusal(Code::Malformed, 4, "header",
                   "more than 11 fields: " + in_quotes(line.substr(at)), byte + at);
  Header header = header_of(values, info);
  if (!has_good_size(header, limits)) [[unlikely]]
    return refuse(*find_size_error(header, limits));
  return header;
}

Status check(const Header& header, const Limits& limits) {
  // Nearly every header is right, which is found out without looking for what may be wrong.
  bool below_0 = (header.src | header.mode | header.coord | header.width | header.height) < 0 ||
                 (header.seq | header.time) < 0;
  if (!below_0 && broken_rule(header.info) == 0 && !has_shape_rule(header.info) &&
      has_good_size(header, limits))
    return {};
  Fields values = {kVersion, header.src,  header.dst,   header.seq,   header.ttl,   header.time,
                   0,        header.mode, header.coord, header.width, header.height};
  auto as_error = [](const Finding& finding) {
    return Error{finding.code, "R" + std::to_string(finding.rule) + " " +
                                   std::string(kRules[finding.field].name) + ": " + finding.what};
  };
  if (auto error = find_error(header.info))
    return as_error({Code::Malformed, error->rule, InfoCode, error->what});
  for (std::size_t field = 0; field < kFields; ++field) {
    if (auto error = find_range_error(field, values[field])) return as_error(*error);
    if (field == Width || field == Height)
      if (auto error = find_shape_error(field, header.width, header.height, header.info))
        return as_error(*error);
  }
  if (auto error = find_size_error(header, limits)) return as_error(*error);
  return {};
}

std::size_t format_header(const Header& header, std::span<char, kMaxHeaderBytes> line) {
  auto put = [](char* at, std::int64_t value, char after) {
    at = internal::write_integer(at, value);
    *at = after;
    return at + 1;
  };
  char* at = line.data();
  at = put(at, kVersion, ' ');
  at = put(at, header.src, ' ');
  at = put(at, header.dst, ' ');
  at = put(at, header.seq, ' ');
  at = put(at, header.ttl, ' ');
  at = put(at, header.time, ' ');
  at = put(at, header.info.code(), ' ');
  at = put(at, header.mode, ' ');
  at = put(at, header.coord, ' ');
  at = put(at, header.width, ' ');
  at = put(at, header.height, '\n');
  return static_cast<std::size_t>(at - line.data());
}

std::string text(const Header& header) {
  char line[kMaxHeaderBytes];
  return {line, format_header(header, line) - 1};
}

}  // namespace hc
