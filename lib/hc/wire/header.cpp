// SPDX-License-Identifier: Apache-2.0
#include <hc/wire/header.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>

#include <hc/wire/digits.h>
#include <hc/wire/refusal.h>

namespace hc {
namespace {

using internal::quoted;
using internal::refusal;

enum Field { Version, Src, Dst, Seq, Ttl, Time, InfoCode, Mode, Coord, Width, Height, kFields };

struct FieldRule {
  std::string_view name;
  std::int64_t least, most;
};

constexpr std::int64_t kMax31 = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kMax63 = std::numeric_limits<std::int64_t>::max();
constexpr int kFirstRule = 6;  // field i is ruled by R(6 + i)
constexpr std::int64_t kMaxJpegSide = 65500;

constexpr std::array<FieldRule, kFields> kRules = {{
    {"version", kVersion, kVersion},
    {"src", 0, kMax31},
    {"dst", std::numeric_limits<std::int32_t>::min(), kMax31},
    {"seq", 0, kMax63},
    {"ttl", 0, 255},
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
  int field = 0;
  std::string what;
};

std::optional<Finding> find_range_error(int field, std::int64_t value) {
  const FieldRule& rule = kRules[field];
  if (value >= rule.least && value <= rule.most) return std::nullopt;
  if (field == Version)
    return Finding{Code::Unsupported, kFirstRule, field,
                   "this reader knows version 1, not " + std::to_string(value)};
  bool below = value < rule.least;
  return Finding{Code::Malformed, kFirstRule + field, field,
                 std::to_string(value) + (below ? " is below " : " is above ") +
                     std::to_string(below ? rule.least : rule.most)};
}

/// The rules that a width or height breaks with its info (R21 … R23).
std::optional<Finding> find_shape_error(int field, const Fields& values, const Info& info) {
  std::int64_t side = values[field];
  if (info.encoding == Encoding::Jpeg && (side < 1 || side > kMaxJpegSide))
    return Finding{Code::Malformed, 21, field,
                   "a jpeg picture's side is 1 to 65500, not " + std::to_string(side)};
  if (field == Width && info.type == MatrixType::SparseGraph && side != 1)
    return Finding{Code::Malformed, 22, field,
                   "a sparse graph has width 1, not " + std::to_string(side)};
  if (field == Height && info.type == MatrixType::DenseGraph && side != values[Width])
    return Finding{Code::Malformed, 23, field,
                   "a dense graph is square, not " + std::to_string(values[Width]) + " x " +
                       std::to_string(side)};
  return std::nullopt;
}

std::optional<Finding> find_size_error(const Header& header, const Limits& limits) {
  // Both sides are below 2³¹ and an element has at most 792 bytes: the product of the sides fits,
  // and so does that of all three when the first is below 2⁵⁴.
  std::uint64_t elements =
      static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height);
  bool fits = elements >> 54 == 0;
  if (fits && elements * header.info.element_bytes() <= limits.element_bytes) return std::nullopt;
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

Info info_of(std::int64_t code) {
  return {static_cast<MatrixType>(code / 10000), static_cast<std::uint8_t>(code / 100 % 100),
          static_cast<Scalar>(code / 10 % 10), static_cast<Encoding>(code % 10)};
}

constexpr std::size_t kFastBytes = 127;  // and a mark for the end: two machine words of marks

/// One bit for each byte of a word, the first the lowest: set where it is a space.
std::uint64_t spaces_in(std::uint64_t word) {
  word ^= 0x2020202020202020;
  std::uint64_t low = (word & 0x7f7f7f7f7f7f7f7f) + 0x7f7f7f7f7f7f7f7f;
  std::uint64_t marks = ~(low | word) & 0x8080808080808080;  // 0x80 where it was a space
  return ((marks >> 7) * 0x0102040810204080) >> 56;
}

/// Where the fields of a line end: at its spaces and at its end.
class FieldEnds {
 public:
  explicit FieldEnds(std::string_view line) {
    std::size_t size = line.size(), whole = size & ~std::size_t{7};
    for (std::size_t i = 0; i < whole; i += 8)
      marks_[i / 64] |= spaces_in(internal::load8(line.data() + i)) << (i % 64);
    if (whole < size) {  // the last word overlaps the one before
      std::uint64_t word = internal::load8(line.data() + size - 8) >> (8 * (8 - size % 8));
      marks_[whole / 64] |= spaces_in(word) << (whole % 64);
    }
    marks_[size / 64] |= std::uint64_t{1} << (size % 64);
  }

  /// The next end; kNone behind the last.
  static constexpr std::size_t kNone = 128;
  std::size_t next() {
    if (marks_[0] != 0) return take(marks_[0]);
    return marks_[1] != 0 ? 64 + take(marks_[1]) : kNone;
  }

 private:
  static std::size_t take(std::uint64_t& marks) {
    auto first = static_cast<std::size_t>(std::countr_zero(marks));
    marks &= marks - 1;
    return first;
  }

  std::uint64_t marks_[2] = {0, 0};
};

/// The value of 1 to 8 digits that end at `end`; sets bits of `bad` when one is no digit. The word
/// that is read stays within the line, which has 8 bytes on one side at least.
std::uint64_t short_value(const char* line, std::size_t begin, std::size_t end,
                          std::uint64_t& bad) {
  auto shift = static_cast<unsigned>(8 - (end - begin)) * 8;
  std::uint64_t word = end >= 8 ? internal::load8(line + end - 8) >> shift << shift
                                : internal::load8(line + begin) << shift;
  word |= 0x3030303030303030 & ~(~std::uint64_t{0} << shift);  // zeros before the digits
  bad |= internal::non_digits(word);
  return internal::value_of_digits(word);
}

/// Reads the spelling that every writer writes; gives false, and leaves the judgement to the slow
/// way, for everything else. All ends are found first, so that no field waits for the one before.
bool parse_canonical(std::string_view line, Fields& values) {
  if (line.size() > kFastBytes || line.size() < 2 * kFields - 1) return false;
  constexpr std::uint64_t kTenTo8 = 100'000'000;
  const char* text = line.data();
  FieldEnds ends(line);
  std::uint64_t bad = 0;
  std::size_t begin = 0;
  for (int field = 0; field < kFields; ++field) {
    std::size_t end = ends.next();
    if (end == FieldEnds::kNone) return false;
    bool negative = field == Dst && text[begin] == '-';
    begin += negative ? 1 : 0;
    std::size_t length = end - begin;
    std::uint64_t value = 0;
    if (length == 1) {
      value = static_cast<std::uint64_t>(text[begin]) - '0';
      bad |= static_cast<std::uint64_t>(value > 9 || (negative && value == 0));
    } else {
      if (length - 2 > 17 || text[begin] == '0') return false;  // 2 to 19 digits
      value = short_value(text, std::max(begin + 8, end) - 8, end, bad);
      if (length > 8) {
        std::size_t middle = end - 8;
        value += kTenTo8 * short_value(text, std::max(begin + 8, middle) - 8, middle, bad);
        if (length > 16) value += kTenTo8 * kTenTo8 * short_value(text, begin, middle - 8, bad);
      }
      if (value > static_cast<std::uint64_t>(kMax63)) return false;
    }
    values[field] = negative ? -static_cast<std::int64_t>(value) : static_cast<std::int64_t>(value);
    begin = end + 1;
  }
  return bad == 0 && ends.next() == FieldEnds::kNone;
}

/// Integers as R5 spells them, or nothing. One that does not fit into 64 bits becomes the largest
/// or smallest that does, which is outside every range that has no such bound itself; `fits` tells.
std::optional<std::int64_t> parse_integer(std::string_view token, bool& fits) {
  std::string_view digits = token;
  if (digits.starts_with('-')) digits.remove_prefix(1);
  if (digits.empty() || (digits.front() == '0' && token.size() > 1)) return std::nullopt;
  for (char c : digits)
    if (c < '0' || c > '9') return std::nullopt;
  std::int64_t value = 0;
  auto status = std::from_chars(token.data(), token.data() + token.size(), value).ec;
  fits = status == std::errc();
  return value;
}

/// The slow way: every spelling that is allowed, and a precise error for every other.
Result<Header> parse_any(std::string_view line, const Limits& limits, std::uint64_t byte) {
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
  for (int field = 0; field < kFields; ++field) {
    skip_spaces();
    begins[field] = at;
    if (at == line.size())
      return refuse({Code::Malformed, 4, field,
                     "missing; a header has 11 fields, this one " + std::to_string(field)});
    std::string_view token = line.substr(at, line.find(' ', at) - at);
    at += token.size();
    bool fits = true;
    auto value = parse_integer(token, fits);
    if (!value) return refuse({Code::Malformed, 5, field, quoted(token) + " is not an integer"});
    if (!fits)
      return refuse({field == Version ? Code::Unsupported : Code::Malformed, kFirstRule + field,
                     field, quoted(token) + " is out of range"});
    values[field] = *value;
    if (auto error = find_range_error(field, *value)) return refuse(*error);
    if (field == InfoCode) {
      auto parsed = parse_info(*value);
      if (!parsed) {  // "R18: what" becomes "R18 info: what, at byte 12"
        const std::string& detail = parsed.error().detail;
        int rule = (detail[1] - '0') * 10 + (detail[2] - '0');
        return refuse({parsed.error().code, rule, field, detail.substr(5)});
      }
      info = *parsed;
    }
    if (field == Width || field == Height)
      if (auto error = find_shape_error(field, values, info)) return refuse(*error);
  }
  skip_spaces();
  if (at < line.size())
    return refusal(Code::Malformed, 4, "header", "more than 11 fields: " + quoted(line.substr(at)),
                   byte + at);
  Header header = header_of(values, info);
  if (auto error = find_size_error(header, limits)) return refuse(*error);
  return header;
}

}  // namespace

Result<Header> parse_header(std::string_view line, const Limits& limits, std::uint64_t byte) {
  Fields values;
  if (parse_canonical(line, values)) {
    bool good = values[Version] == kVersion && values[Ttl] <= 255 && values[Src] <= kMax31 &&
                values[Dst] <= kMax31 && values[Dst] >= -kMax31 - 1 && values[Mode] <= kMax31 &&
                values[Coord] <= kMax31 && values[Width] <= kMax31 && values[Height] <= kMax31 &&
                values[InfoCode] >= 10000 && values[InfoCode] <= 129999;
    if (good) {
      Header header = header_of(values, info_of(values[InfoCode]));
      if (!find_error(header.info) && !find_shape_error(Width, values, header.info) &&
          !find_shape_error(Height, values, header.info) && !find_size_error(header, limits))
        return header;
    }
  }
  return parse_any(line, limits, byte);
}

Status check(const Header& header, const Limits& limits) {
  Fields values = {kVersion, header.src,  header.dst,   header.seq,   header.ttl,   header.time,
                   0,        header.mode, header.coord, header.width, header.height};
  auto as_error = [](const Finding& finding) {
    return Error{finding.code, "R" + std::to_string(finding.rule) + " " +
                                   std::string(kRules[finding.field].name) + ": " + finding.what};
  };
  if (auto error = find_error(header.info))
    return as_error({Code::Malformed, error->rule, InfoCode, error->what});
  for (int field = 0; field < kFields; ++field) {
    if (auto error = find_range_error(field, values[field])) return as_error(*error);
    if (field == Width || field == Height)
      if (auto error = find_shape_error(field, values, header.info)) return as_error(*error);
  }
  if (auto error = find_size_error(header, limits)) return as_error(*error);
  return {};
}

std::size_t format_header(const Header& header, std::span<char, kMaxHeaderBytes> line) {
  using internal::write_digits;
  using internal::write_integer;
  char* at = line.data();
  auto put = [&](std::int64_t value, char after) {
    at = write_integer(at, value);
    *at++ = after;
  };
  *at++ = '0' + kVersion;
  *at++ = ' ';
  put(header.src, ' ');
  put(header.dst, ' ');
  put(header.seq, ' ');
  put(header.ttl, ' ');
  put(header.time, ' ');
  put(header.info.code(), ' ');
  put(header.mode, ' ');
  put(header.coord, ' ');
  put(header.width, ' ');
  put(header.height, '\n');
  return static_cast<std::size_t>(at - line.data());
}

std::string text(const Header& header) {
  char line[kMaxHeaderBytes];
  return {line, format_header(header, line) - 1};
}

}  // namespace hc
