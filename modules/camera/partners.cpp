// SPDX-License-Identifier: Apache-2.0
#include "partners.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;
using Key = Words (*)(const fs::path&);

Words name_of(const fs::path& path) {
  return {path.stem().string()};
}

/// The numbers in a name, without leading zeros.
Words numbers_of(const fs::path& path) {
  constexpr const char* kDigits = "0123456789";
  const std::string name = path.stem().string();
  Words numbers;
  for (std::size_t at = 0; (at = name.find_first_of(kDigits, at)) != name.npos;) {
    const auto end = std::min(name.find_first_not_of(kDigits, at), name.size());
    const auto begin = std::min(name.find_first_not_of('0', at), end - 1);
    numbers.push_back(name.substr(begin, end - begin));
    at = end;
  }
  return numbers;
}

Words last_number_of(const fs::path& path) {
  Words numbers = numbers_of(path);
  return numbers.empty() ? numbers : Words{numbers.back()};
}

/// The files by their keys; empty if two have the same.
std::map<Words, fs::path> by_key(const Paths& paths, Key key) {
  std::map<Words, fs::path> files;
  for (const auto& path : paths)
    if (!files.emplace(key(path), path).second) return {};
  return files;
}

Partners partners_by(const Paths& left, const Paths& right, Key key) {
  Partners partners;
  if (by_key(left, key).empty()) return partners;
  auto rest = by_key(right, key);
  for (const auto& path : left) {
    const auto partner = rest.find(key(path));
    if (partner == rest.end()) {
      partners.alone.push_back(path);
      continue;
    }
    partners.left.push_back(path);
    partners.right.push_back(std::move(partner->second));
    rest.erase(partner);
  }
  for (const auto& path : right)
    if (rest.contains(key(path))) partners.alone.push_back(path);
  return partners;
}

}  // namespace

Partners partners_of(const Paths& left, const Paths& right) {
  Partners best;
  for (const Key key : {name_of, numbers_of, last_number_of}) {
    auto partners = partners_by(left, right, key);
    if (partners.left.size() > best.left.size()) best = std::move(partners);
  }
  return best;
}
