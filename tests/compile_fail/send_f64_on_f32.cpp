// SPDX-License-Identifier: Apache-2.0
// A port of 32-bit floats does not send doubles.
// error: (no matching (member )?function|cannot convert|could not convert|no viable conversion)
#include <hc/node/module.h>

#ifdef HC_WRONG
using Sent = double;
#else
using Sent = float;
#endif

int main(int argc, char** argv) {
  hc::Module module{"wrong", "Sends a number."};
  auto number = module.output("number", hc::table<float>(), "a number");
  module.on_start([&] { number.send(hc::table({Sent{1.5}})); });
  return module.run(argc, argv);
}
