// SPDX-License-Identifier: Apache-2.0
// An output of positions does not take text.
#include <hc/module/module.h>

void send(hc::Output<hc::PositionKind<double>>& output) {
#ifdef HC_WRONG
  output.send("here");
#else
  output.send({1.0, 2.0, 3.0});
#endif
}
