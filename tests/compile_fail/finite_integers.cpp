// SPDX-License-Identifier: Apache-2.0
// Integers are always finite, so a kind of them does not ask for it.
#include <hc/module/module.h>

void declare(hc::Module& module) {
#ifdef HC_WRONG
  module.input("counts", hc::table<int>().finite(), "");
#else
  module.input("counts", hc::table<float>().finite(), "");
#endif
}
