// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/header.h>

#include <array>
#include <charconv>
#include <limits>
#include <optional>

#include <hc/mtp/digits.h>
#include <hc/mtp/refusal.h>

namespace hc {
namespace {

using internal::in_quotes;
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

std::optional<Finding> find_range_error(std::size_t field, std::int64_t value) {
  const FieldRule& rule = kRules[field];
  if (value >= rule.least && value <= rule.most) return std::nullopt;
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
                   "a jpeg picture's side is 1 to 65500, not " + std::to_string(side)};
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

/// Takes the fields off a line in the spelling that every writer writes, and gives up on any other.
/// It goes byte by byte: a branch that is foretold right costs less than arithmetic that the next
/// field would wait for. No digit is asked whether the line ends: the last space is found first,
/// and every field but the last stops there at the latest.
class CanonicalFields {
 public:
  explicit CanonicalFields(std::string_view line)
      : at_(line.data()), last_(at_ + (line.rfind(' ') + 1)), end_(at_ + line.size()) {}

  /// Takes the next field, not the last one, 0 … `most`; gives false for anything else.
  template <class Integer>
  bool take(Integer& field, std::uint64_t most = kMax31) {
    if (at_ >= last_) return false;
    if (auto digit = digit_at(at_); digit <= 9 && at_[1] == ' ') {  // the commonest fields
      field = static_cast<Integer>(digit);
      at_ += 2;
      return true;
    }
    const char* begin = at_;
    std::uint64_t value = 0;
    if (most > kMax31 && last_ - at_ > 16) take_words(value);
    for (; digit_at(at_) <= 9; ++at_) value = value * 10 + digit_at(at_);
    field = static_cast<Integer>(value);
    return is_canonical(begin, value, most) && *at_++ == ' ';
  }

  /// Takes the next field, which may have a sign.
  bool take_signed(std::int32_t& field) {
    if (at_ >= last_ || *at_ != '-') return take(field);
    ++at_;
    std::int64_t value;
    if (!take(value, kMax31 + 1) || value == 0) return false;
    field = static_cast<std::int32_t>(-value);
    return true;
  }

  /// Takes the info field.
  bool take_info(Info& info) {
    if (last_ - at_ < 7) return false;
    unsigned type = digit_at(at_);
    bool has_two_digits = at_[5] != ' ';
    if (has_two_digits ? type != 1 : type > 9) return false;
    if (has_two_digits) type = 10 + digit_at(++at_);
    unsigned tens = digit_at(at_ + 1), ones = digit_at(at_ + 2);
    unsigned scalar = digit_at(at_ + 3), encoding = digit_at(at_ + 4);
    if (type > 12 || tens > 9 || ones > 9 || scalar > 9 || encoding > 9 || at_[5] != ' ')
      return false;
    info = {static_cast<MatrixType>(type), static_cast<std::uint8_t>(10 * tens + ones),
            static_cast<Scalar>(scalar), static_cast<Encoding>(encoding)};
    at_ += 6;
    return broken_rule(info) == 0;
  }

  /// Takes the last field; gives false, too, when others are left.
  bool take_last(std::int32_t& field) {
    if (at_ != last_) return false;
    const char* begin = at_;
    std::uint64_t value = 0;
    for (; at_ < end_ && digit_at(at_) <= 9; ++at_) value = value * 10 + digit_at(at_);
    field = static_cast<std::int32_t>(value);
    return is_canonical(begin, value, kMax31) && at_ == end_;
  }

 private:
  static unsigned digit_at(const char* at) { return static_cast<unsigned>(*at - '0'); }

  /// Whether the digits that end here are a number as R5 wants it; 19 digits fit into 64 bits.
  bool is_canonical(const char* begin, std::uint64_t value, std::uint64_t most) const {
    auto length = at_ - begin;
    return value <= most && (length == 1 || (length > 1 && length <= 19 && *begin != '0'));
  }

  /// As many as 16 digits, if so many are next.
  void take_words(std::uint64_t& value) {
    for (int i = 0; i < 2; ++i) {
      std::uint64_t word = internal::load8(at_);
      if (internal::non_digits(word) != 0) return;
      value = value * 100'000'000 + internal::value_of_digits(word);
      at_ += 8;
    }
  }

  const char* at_;
  const char* last_;  // where the last field begins
  const char* end_;
};

/// Whether a header's sides have rules of their own (R21 … R23).
bool has_shape_rule(const Info& info) {
  return info.encoding == Encoding::Jpeg || info.type == MatrixType::DenseGraph ||
         info.type == MatrixType::SparseGraph;
}

/// Reads a header in canonical form; gives false, and leaves the judgement to the slow way, for
/// every other one and for those whose sides have rules of their own (R21 … R23).
bool parse_canonical(std::string_view line, const Limits& limits, Header& header) {
  CanonicalFields fields(line);
  int version;
  return fields.take(version) && version == kVersion && fields.take(header.src) &&
         fields.take_signed(header.dst) && fields.take(header.seq, kMax63) &&
         fields.take(header.ttl, kMaxTtl) && fields.take(header.time, kMax63) &&
         fields.take_info(header.info) && fields.take(header.mode) && fields.take(header.coord) &&
         fields.take(header.width) && fields.take_last(header.height) &&
         !has_shape_rule(header.info) && has_good_size(header, limits);
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
  for (std::size_t field = 0; field < kFields; ++field) {
    skip_spaces();
    begins[field] = at;
    if (at == line.size())
      return refuse({Code::Malformed, 4, field,
                     "missing; a header has 11 fields, this one " + std::to_string(field)});
    std::string_view token = line.substr(at, line.find(' ', at) - at);
    at += token.size();
    bool fits = true;
    auto value = parse_integer(token, fits);
    if (!value) return refuse({Code::Malformed, 5, field, in_quotes(token) + " is not an integer"});
    if (!fits)
      return refuse({field == Version ? Code::Unsupported : Code::Malformed,
                     kFirstRule + static_cast<int>(field), field,
                     in_quotes(token) + " is out of range"});
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
      if (auto error = find_shape_error(field, values[Width], values[Height], info))
        return refuse(*error);
  }
  skip_spaces();
  if (at < line.size())
    return refusal(Code::Malformed, 4, "header",
                   "more than 11 fields: " + in_quotes(line.substr(at)), byte + at);
  Header header = header_of(values, info);
  if (auto error = find_size_error(header, limits)) return refuse(*error);
  return header;
}

}  // namespace

Result<Header> parse_header(std::string_view line, const Limits& limits, std::uint64_t byte) {
  Result<Header> header = Header{};
  if (parse_canonical(line, limits, *header)) return header;
  return parse_any(line, limits, byte);
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
