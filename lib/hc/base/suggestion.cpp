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
  // A third of the letters may differ; leading dashes of an option do not count.
  const std::size_t letters = name.size() - std::min(name.find_first_not_of('-'), name.size());
  const std::size_t most = std::min(kNear, (letters + 1) / 3);
  const std::string ending = "_" + std::string(name);  // behind the prefix of an included graph
  const auto away = [&](const std::string& word) {
    return word.ends_with(ending) ? kNear : distance(name.substr(0, 64), word);
  };
  const auto best = std::ranges::min_element(known, {}, away);
  if (best == known.end() || away(*best) > most) return "";
  return ", did you mean \"" + *best + "\"?";
}

}  // namespace hc
