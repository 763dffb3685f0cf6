// SPDX-License-Identifier: Apache-2.0
// A number that the port's scalar cannot hold is not sent.
#include <hc/module/module.h>

void send(hc::Output<hc::TableKind<std::int32_t>>& output, double score) {
#ifdef HC_WRONG
  output.send(score);
#else
  output.send(static_cast<std::int32_t>(score));
#endif
}
