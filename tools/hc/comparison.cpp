// SPDX-License-Identifier: Apache-2.0
#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>

#include <hc/base/format.h>
#include <hc/mtp/element.h>
#include <hc/mtp/matrix_view.h>

namespace tool {
namespace {

constexpr std::chrono::seconds kDisorder{1};

template <typename T>
std::string both(std::string_view field, const T& recorded, const T& replayed) {
  return hc::format("{}: {} recorded, {} replayed", field, recorded, replayed);
}

template <typename T>
std::string difference_of(const hc::Message& recorded, const hc::Message& replayed,
                          double tolerance) {
  const auto a = hc::view<T>(recorded)->numbers(), b = hc::view<T>(replayed)->numbers();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto one = static_cast<double>(a[i]), other = static_cast<double>(b[i]);
    const bool is_same =  // also for NaN with the same bits
        std::ranges::equal(std::as_bytes(std::span(&a[i], 1)),
                           std::as_bytes(std::span(&b[i], 1))) ||
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

struct KeptMessage {
  hc::Message message;
  bool is_matched = false;
};
using Messages = std::multimap<hc::Time, KeptMessage>;  // by time

/// Takes the next message. A message without a time gets that of the previous one.
bool take(const NextMessage& next, hc::Time& time, hc::Message& message) {
  if (!next(message)) return false;
  if (message.header.time != hc::Time()) time = message.header.time;
  return true;
}

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
  if (std::ranges::equal(recorded.elements, replayed.elements)) return "";
  if (a.info.type == hc::MatrixType::String)
    return both("text", "\"" + std::string(recorded.text()) + "\"",
                "\"" + std::string(replayed.text()) + "\"");
  return hc::visit_scalar(a.info.scalar, [&](auto zero) {
    return difference_of<decltype(zero)>(recorded, replayed, tolerance.number);
  });
}

bool Comparison::is_same(const Tolerance& tolerance) const {
  const auto all = static_cast<double>(same + differing + missing + extra);
  return static_cast<double>(same) >= tolerance.share * all && (same > 0 || after_end == 0);
}

std::string Comparison::text() const {
  std::string text = hc::format("{} messages", recorded);
  if (differing + missing + extra == 0 && (same > 0 || after_end == 0)) text += ", the same";
  for (const auto& [count, what] : {std::pair(differing, "differ"),
                                    {missing, "missing"},
                                    {extra, "more"},
                                    {after_end, "after the last whole step"}})
    if (count > 0) text += hc::format(", {} {}", count, what);
  return first.empty() ? text : text + "; first: " + first;
}

Comparison compare(const NextMessage& recorded, const NextMessage& replayed,
                   const Tolerance& tolerance, std::int64_t last) {
  Comparison result;
  Messages held;  // of the replay, within 1 s of the current recorded message
  hc::Time time, again_time;
  std::optional<hc::Time> begin;
  hc::Message message;
  auto note = [&](const hc::Header& header, hc::Time at, const std::string& what) {
    if (result.first.empty())
      result.first = hc::format("seq {}, {:.3f} s after the first: {}", header.seq,
                                hc::seconds(at - begin.value_or(at)), what);
  };
  auto hold_next = [&] {
    hc::Message other;
    if (!take(replayed, again_time, other)) return false;
    ++result.replayed;
    held.emplace(again_time, KeptMessage{other.keep()});
    return true;
  };
  auto drop_until = [&](Messages::iterator end) {
    for (auto each = held.begin(); each != end; each = held.erase(each)) {
      if (each->second.is_matched) continue;
      ++result.extra;
      note(each->second.message.header, each->first, "replayed but not recorded");
    }
  };
  for (bool has_more = true; take(recorded, time, message);) {
    begin = begin.value_or(time);
    ++result.recorded;
    const auto reach = hc::later(time, tolerance.time + kDisorder);
    while (has_more && (held.empty() || std::prev(held.end())->first <= reach))
      has_more = hold_next();
    drop_until(held.lower_bound(time - tolerance.time - kDisorder));
    bool is_found = false;
    std::string what;
    KeptMessage* nearest = nullptr;
    std::chrono::nanoseconds distance{0};
    const auto end = held.upper_bound(hc::later(time, tolerance.time));
    for (auto each = held.lower_bound(time - tolerance.time); each != end; ++each) {
      auto& candidate = each->second;
      // Without a tolerance of time, match one to one; otherwise a message may match several.
      if (tolerance.time.count() == 0 && candidate.is_matched) continue;
      const auto differs = difference(message, candidate.message, tolerance);
      if (differs.empty()) {
        is_found = candidate.is_matched = true;
        if (tolerance.time.count() == 0) break;
      } else if (!candidate.is_matched &&
                 (nearest == nullptr || std::chrono::abs(each->first - time) < distance)) {
        nearest = &candidate;
        distance = std::chrono::abs(each->first - time);
        what = differs;
      }
    }
    if (is_found) {
      ++result.same;
    } else if (nearest != nullptr) {
      nearest->is_matched = true;
      ++result.differing;
      note(message.header, time, what);
    } else if (message.header.seq > last) {
      ++result.after_end;
    } else {
      ++result.missing;
      note(message.header, time, "recorded but not replayed");
    }
  }
  while (hold_next()) drop_until(held.lower_bound(std::prev(held.end())->first - kDisorder));
  drop_until(held.end());
  return result;
}

}  // namespace tool
