// SPDX-License-Identifier: Apache-2.0
// The null pointer is no text.
#include <hc/module/module.h>

void send(hc::Output<hc::StringKind>& output) {
#ifdef HC_WRONG
  output.send(0);
#else
  output.send("0");
#endif
}
