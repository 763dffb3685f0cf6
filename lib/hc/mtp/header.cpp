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

enum Field : unsigned { Version, Src, Dst, Seq, Ttl, Time, InfoCode, Mode, Coord, Width, Height };
constexpr std::size_t kFields = Height + 1;

struct FieldRule {
  std::string_view name;
  std::int64_t least, most;
};

constexpr std::int64_t kMax31 = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kMax63 = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kMaxTtl = 255;
constexpr int kFirstRule = 6;  // R(6 + i) limits field i
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

/// Whether rules R21 … R23 limit the sides of the matrix.
bool has_shape_rule(const Info& info) {
  return info.encoding == Encoding::Jpeg || info.type == MatrixType::DenseGraph ||
         info.type == MatrixType::SparseGraph;
}

/// The rule that a width or height breaks with its info (R21 … R23).
std::optional<InfoError> find_shape_error(std::size_t field, std::int64_t width,
                                          std::int64_t height, const Info& info) {
  std::int64_t side = field == Width ? width : height;
  if (info.encoding == Encoding::Jpeg && (side < 1 || side > kMaxJpegSide))
    return InfoError{21, "the side of a JPEG image is 1 to 65500, not " + std::to_string(side)};
  if (field == Width && info.type == MatrixType::SparseGraph && side != 1)
    return InfoError{22, "a sparse graph has width 1, not " + std::to_string(side)};
  if (field == Height && info.type == MatrixType::DenseGraph && side != width)
    return InfoError{23, "a dense graph is square, not " + std::to_string(width) + " x " +
                             std::to_string(height)};
  return std::nullopt;
}

bool fits_limits(const Header& header, const Limits& limits) {
  // Both sides are below 2³¹ and an element has at most 792 bytes, so the product of the sides fits
  // into 64 bits, and the product of all three does if the first is below 2⁵⁴.
  std::uint64_t elements =
      static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height);
  return elements >> 54 == 0 && elements * header.info.element_bytes() <= limits.element_bytes;
}

Header header_of(const Fields& values, const Info& info) {
  Header header;
  header.src = static_cast<std::int32_t>(values[Src]);
  header.dst = static_cast<std::int32_t>(values[Dst]);
  header.seq = values[Seq];
  header.ttl = static_cast<std::uint8_t>(values[Ttl]);
  header.time = unix_time(values[Field::Time]);
  header.info = info;
  header.mode = static_cast<std::int32_t>(values[Mode]);
  header.coord = static_cast<std::int32_t>(values[Coord]);
  header.width = static_cast<std::int32_t>(values[Width]);
  header.height = static_cast<std::int32_t>(values[Height]);
  return header;
}

/// parse_header(); errors give the byte if `byte` is set.
Result<Header> parse(std::string_view line, const Limits& limits,
                     std::optional<std::uint64_t> byte) {
  Fields values{};
  std::array<std::size_t, kFields> begins{};
  Info info;
  std::size_t at = 0;
  auto skip_spaces = [&] {
    while (at < line.size() && line[at] == ' ') ++at;
  };
  auto refuse = [&](Code code, int rule, std::size_t field, const std::string& what) {
    if (byte) *byte += begins[field];
    return refusal(code, rule, kRules[field].name, what, byte);
  };
  for (std::size_t field = 0; field < kFields; ++field) {
    skip_spaces();
    begins[field] = at;
    if (at == line.size())
      return refuse(Code::Malformed, 4, field,
                    "missing; a header has 11 fields, this one " + std::to_string(field));
    const char *const end = line.data() + line.size(), *next = nullptr;
    std::int64_t& value = values[field];
    auto outcome = internal::read_integer(line.data() + at, end, value, next);
    if (next != end && *next != ' ') outcome = Outcome::NotANumber;
    const Code code = field == Version ? Code::Unsupported : Code::Malformed;
    const int rule = kFirstRule + static_cast<int>(field);
    if (outcome != Outcome::Good) [[unlikely]] {
      const auto token = in_quotes(line.substr(at, line.find(' ', at) - at));
      if (outcome == Outcome::NotANumber)
        return refuse(Code::Malformed, 5, field, token + " is not an integer");
      return refuse(code, rule, field, token + " is out of range");
    }
    at = static_cast<std::size_t>(next - line.data());
    const auto [name, least, most] = kRules[field];
    if (value < least || value > most) [[unlikely]] {
      const auto number = std::to_string(value);
      return refuse(code, rule, field,
                    field == Version ? "this reader supports version 1, not " + number
                    : value < least  ? number + " is below " + std::to_string(least)
                                     : number + " is above " + std::to_string(most));
    }
    std::optional<InfoError> error;
    if (field == InfoCode)
      error = parse_info(value, info);
    else if ((field == Width || field == Height) && has_shape_rule(info))
      error = find_shape_error(field, values[Width], values[Height], info);
    if (error) return refuse(error->code(), error->rule, field, error->what);
  }
  skip_spaces();
  if (at < line.size()) {
    if (byte) *byte += at;
    return refusal(Code::Malformed, 4, "header",
                   "more than 11 fields: " + in_quotes(line.substr(at)), byte);
  }
  Header header = header_of(values, info);
  if (!fits_limits(header, limits)) [[unlikely]]
    return refuse(Code::TooLarge, 24, Width,
                  std::to_string(header.width) + " x " + std::to_string(header.height) + " x " +
                      std::to_string(info.element_bytes()) + " bytes exceed the limit of " +
                      std::to_string(limits.element_bytes));
  return header;
}

}  // namespace

Result<Header> parse_header(std::string_view line, const Limits& limits, std::uint64_t byte) {
  return parse(line, limits, byte);
}

Status check(const Header& header, const Limits& limits) {
  // Fast path: nearly all headers are valid, and need not be formatted and parsed for this.
  bool below_0 = (header.src | header.mode | header.coord | header.width | header.height) < 0 ||
                 (header.seq | unix_nanoseconds(header.time)) < 0;
  if (!below_0 && broken_rule(header.info) == 0 && !has_shape_rule(header.info) &&
      fits_limits(header, limits))
    return {};
  if (auto error = find_error(header.info))  // code() could be that of another, valid info
    return refusal(error->code(), error->rule, kRules[InfoCode].name, error->what, std::nullopt);
  auto parsed = parse(text(header), limits, std::nullopt);
  return parsed ? Status() : parsed.error();
}

std::size_t format_header(const Header& header, std::span<char, kMaxHeaderBytes> line) {
  const Fields values = {kVersion,           header.src,   header.dst,
                         header.seq,         header.ttl,   unix_nanoseconds(header.time),
                         header.info.code(), header.mode,  header.coord,
                         header.width,       header.height};
  char* at = line.data();
  for (auto value : values) {
    at = internal::write_integer(at, value);
    *at++ = ' ';
  }
  at[-1] = '\n';
  return static_cast<std::size_t>(at - line.data());
}

std::string text(const Header& header) {
  char line[kMaxHeaderBytes];
  return {line, format_header(header, line) - 1};
}

}  // namespace hc
