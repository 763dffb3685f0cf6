// SPDX-License-Identifier: Apache-2.0
#include "recording.h"

#include <filesystem>
#include <string_view>

#include <hc/base/format.h>

std::string free_name(const std::string& path,
                      const std::function<bool(const std::string& path)>& is_free) {
  const std::string_view ending = path.ends_with(".mcap") ? ".mcap" : "";
  std::string stem = path.substr(0, path.size() - ending.size());
  auto strip = [&stem] {  // "kept/"
    while (stem.size() > 1 && stem.ends_with('/')) stem.pop_back();
  };
  strip();
  if (const auto last = std::filesystem::path(stem).filename(); last == "." || last == "..")
    stem = std::filesystem::weakly_canonical(std::filesystem::absolute(stem)).string();
  strip();
  std::string name = path;
  for (int i = 2; !is_free(name); ++i) name = hc::format("{}_{}{}", stem, i, ending);
  return name;
}
