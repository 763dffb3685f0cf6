// SPDX-License-Identifier: Apache-2.0
// The handler of two inputs that are taken together takes two messages.
#include <hc/module/module.h>

void take(hc::Module& module, const hc::Input<hc::PositionKind<double>>& left,
          const hc::Input<hc::PositionKind<double>>& right) {
#ifdef HC_WRONG
  module.on(hc::together(left, right), [](const hc::Message&) {});
#else
  module.on(hc::together(left, right), [](const hc::Message&, const hc::Message&) {});
#endif
}
