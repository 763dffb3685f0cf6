// SPDX-License-Identifier: Apache-2.0
// Text does not go out of a port of positions, and positions have no integers.
#include <hc/module/module.h>

void send(hc::Output<hc::PositionKind<double>>& output) {
#ifdef HC_WRONG
  output.send(hc::string("here"));
#else
  output.send(hc::position(1.0, 2.0, 3.0));
#endif
}
