// SPDX-License-Identifier: Apache-2.0
// A position has no integers.
#include <hc/module/module.h>

void declare(hc::Module& module) {
#ifdef HC_WRONG
  module.input("place", hc::position<int>(), "");
#else
  module.input("place", hc::position(), "");
#endif
}
