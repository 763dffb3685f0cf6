// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which messages a link takes, by their address, and who is at its other end. Pure. Internal.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>

namespace hc::internal {

/// What `--route 'PORT=URI WORDS'` says of a link.
struct Route {
  bool takes_all = true;         ///< no `to=`, or `to=*`
  std::vector<std::int32_t> to;  ///< the dst that go here, in rising order
  std::string peer;              ///< who is at the other end, where it matters

  [[nodiscard]] bool takes(std::int32_t dst) const;
};

/// Reads words like `to=21,-5,-1 peer=eye`. Errors: Invalid.
Result<Route> parse_route(std::string_view words);

}  // namespace hc::internal
