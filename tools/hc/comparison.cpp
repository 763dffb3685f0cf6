// SPDX-License-Identifier: Apache-2.0
#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <utility>

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

namespace {

/// Compares two streams of messages, each in the order of time within kDisorder.
class Comparer {
 public:
  Comparer(const NextMessage& replayed, const Tolerance& tolerance, std::int64_t last)
      : replayed_(replayed), tolerance_(tolerance), last_(last) {}

  /// Takes the next recorded message.
  void compare(const hc::Message& recorded, hc::Time time) {
    begin_ = begin_.value_or(time);
    ++result_.recorded;
    const auto reach = hc::later(time, kDisorder);
    while (has_more_ && (held_.empty() || std::prev(held_.end())->first <= reach))
      has_more_ = hold_next();
    drop_until(held_.lower_bound(time - kDisorder));
    count(recorded, time, match(recorded, time));
  }

  /// Takes the rest of the replay.
  Comparison finish() {
    while (hold_next()) drop_until(held_.lower_bound(std::prev(held_.end())->first - kDisorder));
    drop_until(held_.end());
    return std::move(result_);
  }

 private:
  struct Match {
    bool is_found = false;
    KeptMessage* other = nullptr;  ///< the first that is not the same, of those without a match
    std::string difference;        ///< from it
  };

  /// The same message of the replay, of this time.
  Match match(const hc::Message& recorded, hc::Time time) {
    Match found;
    const auto [begin, end] = held_.equal_range(time);
    for (auto each = begin; each != end && !found.is_found; ++each) {
      auto& candidate = each->second;
      if (candidate.is_matched) continue;
      auto differs = difference(recorded, candidate.message, tolerance_);
      if (differs.empty()) {
        found.is_found = candidate.is_matched = true;
      } else if (found.other == nullptr) {
        found.other = &candidate;
        found.difference = std::move(differs);
      }
    }
    return found;
  }

  void count(const hc::Message& recorded, hc::Time time, const Match& match) {
    if (match.is_found) {
      ++result_.same;
    } else if (match.other != nullptr) {
      match.other->is_matched = true;
      ++result_.differing;
      note(recorded.header, time, match.difference);
    } else if (recorded.header.seq > last_) {
      ++result_.after_end;
    } else {
      ++result_.missing;
      note(recorded.header, time, "recorded but not replayed");
    }
  }

  bool hold_next() {
    hc::Message message;
    if (!take(replayed_, replayed_time_, message)) return false;
    held_.emplace(replayed_time_, KeptMessage{message.keep()});
    return true;
  }

  void drop_until(Messages::iterator end) {
    for (auto each = held_.begin(); each != end; each = held_.erase(each)) {
      if (each->second.is_matched) continue;
      ++result_.extra;
      note(each->second.message.header, each->first, "replayed but not recorded");
    }
  }

  void note(const hc::Header& header, hc::Time at, const std::string& what) {
    if (result_.first.empty())
      result_.first = hc::format("seq {}, {:.3f} s after the first: {}", header.seq,
                                 hc::seconds(at - begin_.value_or(at)), what);
  }

  const NextMessage& replayed_;
  const Tolerance& tolerance_;
  const std::int64_t last_;
  Comparison result_;
  Messages held_;  // of the replay, within 1 s of the current recorded message
  bool has_more_ = true;
  hc::Time replayed_time_;
  std::optional<hc::Time> begin_;
};

}  // namespace

Comparison compare(const NextMessage& recorded, const NextMessage& replayed,
                   const Tolerance& tolerance, std::int64_t last) {
  Comparer comparer(replayed, tolerance, last);
  hc::Time time;
  for (hc::Message message; take(recorded, time, message);) comparer.compare(message, time);
  return comparer.finish();
}

}  // namespace tool
