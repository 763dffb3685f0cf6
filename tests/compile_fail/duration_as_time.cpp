// SPDX-License-Identifier: Apache-2.0
// A duration is not a time, and the monotonic clock is not that of messages.
#include <hc/module/module.h>

void send(hc::Output<hc::PositionKind<double>>& output, hc::Module& module) {
#ifdef HC_WRONG
  output.send({1.0, 2.0, 3.0}, module.monotonic());
#else
  output.send({1.0, 2.0, 3.0}, module.now());
#endif
}
