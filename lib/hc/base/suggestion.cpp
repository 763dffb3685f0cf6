// SPDX-License-Identifier: Apache-2.0
#include <hc/base/suggestion.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace hc {
namespace {

/// Edit distance: letters to change, insert or delete and neighbours to swap.
/// Source: optimal string alignment; three rows of the table are kept.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      std::size_t changed = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({changed, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kNear = 3;
  const std::string* best = nullptr;
  // A third of the letters may differ; leading dashes of an option do not count.
  const std::size_t letters = name.size() - std::min(name.find_first_not_of('-'), name.size());
  std::size_t beyond = std::min(kNear, (letters + 1) / 3) + 1;
  for (const auto& word : known)
    if (std::size_t away = distance(name.substr(0, 64), word); away < beyond) {
      beyond = away;
      best = &word;
    }
  return best == nullptr ? "" : ", did you mean \"" + *best + "\"?";
}

}  // namespace hc
