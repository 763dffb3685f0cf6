// SPDX-License-Identifier: Apache-2.0
#include <hc/base/suggestion.h>

#include <algorithm>
#include <utility>

namespace hc {
namespace {

/// Letters to change, add or leave out until one word is the other.
/// Source: Levenshtein's distance, by the usual table of which one row is kept.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kNear = 3;
  const std::string* best = nullptr;
  std::size_t least = std::min(kNear, name.size() / 2 + 1);
  for (const auto& word : known) {
    std::size_t away = distance(name.substr(0, 64), word);
    if (away < least || (away == least && best == nullptr && away < name.size())) {
      least = away;
      best = &word;
    }
  }
  return best == nullptr ? "" : ", did you mean \"" + *best + "\"?";
}

}  // namespace hc
