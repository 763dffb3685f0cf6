// SPDX-License-Identifier: Apache-2.0
// An output of f32 does not take f64.
#include <hc/module/module.h>

void send(hc::Output<hc::PositionKind<float>>& output) {
#ifdef HC_WRONG
  const double numbers[] = {1, 2, 3};
  output.send(numbers);
#else
  const float numbers[] = {1, 2, 3};
  output.send(numbers);
#endif
}
