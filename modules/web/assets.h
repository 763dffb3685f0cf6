// SPDX-License-Identifier: Apache-2.0
#pragma once
// The page's files, compiled into the program; scripts/build_page writes the source file.

#include <string_view>
#include <vector>

struct Asset {
  std::string_view path;   ///< below `/`
  std::string_view type;   ///< MIME
  std::string_view bytes;  ///< compressed by gzip
};

const std::vector<Asset>& page_assets();
