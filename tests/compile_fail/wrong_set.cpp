// SPDX-License-Identifier: Apache-2.0
// A handler of two inputs takes two messages.
#include <hc/module/module.h>

void take(hc::Module& module, const hc::Input<hc::PositionKind<double>>& left,
          const hc::Input<hc::PositionKind<double>>& right) {
#ifdef HC_WRONG
  module.on(hc::together(left, right), [](const hc::Message&) {});
#else
  module.on(hc::together(left, right), [](const hc::Message&, const hc::Message&) {});
#endif
}
