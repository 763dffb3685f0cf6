// SPDX-License-Identifier: Apache-2.0
#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <optional>
#include <span>

#include <hc/base/format.h>

namespace tool {
namespace {

constexpr std::int64_t kDisorder = 1'000'000'000;  // [ns]

template <typename T>
std::string both(std::string_view field, const T& recorded, const T& replayed) {
  return hc::format("{}: {} recorded, {} replayed", field, recorded, replayed);
}

template <typename T>
std::string difference_of(const hc::Message& recorded, const hc::Message& replayed,
                          double tolerance) {
  const auto a = recorded.view<T>()->numbers(), b = replayed.view<T>()->numbers();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto one = static_cast<double>(a[i]), other = static_cast<double>(b[i]);
    const bool is_same =  // two NaN of the same bits are
        std::ranges::equal(std::as_bytes(a.subspan(i, 1)), std::as_bytes(b.subspan(i, 1))) ||
        (tolerance > 0 && std::abs(one - other) <= tolerance);
    if (is_same) continue;
    const auto components = recorded.header.info.components;
    const auto element = i / components, width = static_cast<std::size_t>(recorded.header.width);
    return both(hc::format("row {}, column {}, component {}", element / width, element % width,
                           i % components),
                one, other);
  }
  return "";
}

std::string difference_of_elements(const hc::Message& a, const hc::Message& b, double tolerance) {
  using hc::Scalar;
  switch (a.header.info.scalar) {
    case Scalar::U8:
      return difference_of<std::uint8_t>(a, b, tolerance);
    case Scalar::I8:
      return difference_of<std::int8_t>(a, b, tolerance);
    case Scalar::U16:
      return difference_of<std::uint16_t>(a, b, tolerance);
    case Scalar::I16:
      return difference_of<std::int16_t>(a, b, tolerance);
    case Scalar::U32:
      return difference_of<std::uint32_t>(a, b, tolerance);
    case Scalar::I32:
      return difference_of<std::int32_t>(a, b, tolerance);
    case Scalar::U64:
      return difference_of<std::uint64_t>(a, b, tolerance);
    case Scalar::I64:
      return difference_of<std::int64_t>(a, b, tolerance);
    case Scalar::F32:
      return difference_of<float>(a, b, tolerance);
    case Scalar::F64:
      return difference_of<double>(a, b, tolerance);
  }
  return "";
}

/// One recording, of which a second either way of what is looked at is held.
class Reader {
 public:
  explicit Reader(const NextMessage& next) : next_(next) {}

  /// The next message, with the time that it has: its own, or that of the one before it.
  std::optional<std::pair<std::int64_t, hc::Message>> take() {
    hc::Message message;
    if (!next_(message)) return std::nullopt;
    if (message.header.time != 0) time_ = message.header.time;
    return std::pair(time_, message.keep());
  }

 private:
  const NextMessage& next_;
  std::int64_t time_ = 0;
};

struct KeptMessage {
  hc::Message message;
  bool is_matched = false;
};

}  // namespace

std::string difference(const hc::Message& recorded, const hc::Message& replayed,
                       const Tolerance& tolerance) {
  const auto &a = recorded.header, &b = replayed.header;
  const auto kind = hc::matrix_text(a.info), other_kind = hc::matrix_text(b.info);
  if (kind != other_kind) return both("type", kind, other_kind);
  const std::pair<std::string_view, std::int32_t hc::Header::*> fields[] = {
      {"dst", &hc::Header::dst},     {"mode", &hc::Header::mode},     {"coord", &hc::Header::coord},
      {"width", &hc::Header::width}, {"height", &hc::Header::height},
  };
  for (const auto& [name, field] : fields)
    if (a.*field != b.*field) return both(name, a.*field, b.*field);
  if (recorded.elements.size() == replayed.elements.size() &&
      std::equal(recorded.elements.begin(), recorded.elements.end(), replayed.elements.begin()))
    return "";
  if (a.info.type == hc::MatrixType::String)
    return both("text", "\"" + std::string(recorded.characters()) + "\"",
                "\"" + std::string(replayed.characters()) + "\"");
  return difference_of_elements(recorded, replayed, tolerance.number);
}

bool Comparison::is_same(const Tolerance& tolerance) const {
  const auto all = static_cast<double>(same + differing + missing + extra);
  return static_cast<double>(same) >= tolerance.share * all;
}

std::string Comparison::text() const {
  std::string text = hc::format("{} messages", recorded);
  if (differing + missing + extra == 0) return text + ", the same";
  for (const auto& [count, what] :
       {std::pair(differing, "differ"), {missing, "missing"}, {extra, "more"}})
    if (count > 0) text += hc::format(", {} {}", count, what);
  return text + "; first: " + first;
}

Comparison compare(const NextMessage& recorded, const NextMessage& replayed,
                   const Tolerance& tolerance) {
  Comparison result;
  Reader kept(recorded), again(replayed);
  std::multimap<std::int64_t, KeptMessage> held;  // of the replay, by time
  bool has_more = true;
  std::optional<std::int64_t> begin;
  auto note = [&](const hc::Header& header, std::int64_t time, const std::string& what) {
    if (result.first.empty())
      result.first = hc::format("seq {}, {:.3f} s after the first: {}", header.seq,
                                static_cast<double>(time - begin.value_or(time)) * 1e-9, what);
  };
  auto drop_until = [&](std::multimap<std::int64_t, KeptMessage>::iterator end) {
    for (auto each = held.begin(); each != end; each = held.erase(each)) {
      if (each->second.is_matched) continue;
      ++result.extra;
      note(each->second.message.header, each->first, "not recorded, and replayed");
    }
  };
  while (const auto next = kept.take()) {
    const auto& [time, message] = *next;
    begin = begin.value_or(time);
    ++result.recorded;
    const auto reach = time + tolerance.time + kDisorder;
    while (has_more && (held.empty() || std::prev(held.end())->first <= reach)) {
      auto other = again.take();
      has_more = other.has_value();
      if (!has_more) break;
      ++result.replayed;
      held.emplace(other->first, KeptMessage{std::move(other->second)});
    }
    drop_until(held.lower_bound(time - tolerance.time - kDisorder));
    const auto first = held.lower_bound(time - tolerance.time);
    const auto end = held.upper_bound(time + tolerance.time);
    bool is_found = false;
    std::string what;
    KeptMessage* nearest = nullptr;
    std::int64_t distance = 0;
    for (auto each = first; each != end; ++each) {
      auto& candidate = each->second;
      // One by one where times are equal; else what is said at a time, as often as it is.
      if (tolerance.time == 0 && candidate.is_matched) continue;
      const auto differs = difference(message, candidate.message, tolerance);
      if (differs.empty()) {
        is_found = candidate.is_matched = true;
        if (tolerance.time == 0) break;
      } else if (!candidate.is_matched &&
                 (nearest == nullptr || std::abs(each->first - time) < distance)) {
        nearest = &candidate;
        distance = std::abs(each->first - time);
        what = differs;
      }
    }
    if (is_found) {
      ++result.same;
    } else if (nearest != nullptr) {
      nearest->is_matched = true;
      ++result.differing;
      note(message.header, time, what);
    } else {
      ++result.missing;
      note(message.header, time, "recorded, and not replayed");
    }
  }
  while (auto other = again.take()) {
    ++result.replayed;
    held.emplace(other->first, KeptMessage{std::move(other->second)});
    drop_until(held.lower_bound(std::prev(held.end())->first - kDisorder));
  }
  drop_until(held.end());
  return result;
}

}  // namespace tool
