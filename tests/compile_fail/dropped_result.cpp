// SPDX-License-Identifier: Apache-2.0
// A failure cannot be overlooked.
// error: nodiscard|unused-result
#include <hc/base/uri.h>

int main() {
#ifdef HC_WRONG
  hc::parse_uri("tcp:");
#else
  auto uri = hc::parse_uri("tcp:");
  return uri.has_value() ? 0 : 1;
#endif
}
