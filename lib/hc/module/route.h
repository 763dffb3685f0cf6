// SPDX-License-Identifier: Apache-2.0
#pragma once
// Routing by address: the messages of a link, and its peer. Pure. Internal.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>

namespace hc::internal {

/// The route of a link: `--route 'PORT=URI WORDS'`.
struct Route {
  bool takes_all = true;         ///< no `to=`, or `to=*`
  std::vector<std::int32_t> to;  ///< accepted dst, ascending
  std::string peer;              ///< the graph or module at the other end; empty: unknown

  [[nodiscard]] bool takes(std::int32_t dst) const;
};

/// Reads words like `to=21,-5,-1 peer=eye`. Errors: Invalid.
Result<Route> parse_route(std::string_view words);

}  // namespace hc::internal
