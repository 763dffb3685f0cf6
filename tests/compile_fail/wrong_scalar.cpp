// SPDX-License-Identifier: Apache-2.0
// An output of f32 does not take f64.
#include <hc/module/module.h>

void send(hc::Output<hc::PositionKind<float>>& output) {
#ifdef HC_WRONG
  output.send({1.0, 2.0, 3.0});
#else
  output.send({1.0F, 2.0F, 3.0F});
#endif
}
