// SPDX-License-Identifier: Apache-2.0
// A number of seconds is not a time.
#include <hc/module/module.h>

void send(hc::Output<hc::PositionKind<double>>& output) {
#ifdef HC_WRONG
  output.send({1.0, 2.0, 3.0}, 1763683200);
#else
  output.send({1.0, 2.0, 3.0}, hc::Time(std::chrono::seconds(1763683200)));
#endif
}
